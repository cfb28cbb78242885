/* The experiments of physics.c, by what they need. */
#ifndef RELIEF_APP_EVAL_PHYSICS_H
#define RELIEF_APP_EVAL_PHYSICS_H

#include "eval/sections.h"
#include "eval/sheet.h"

/* A world without a border; its bodies are added by the caller. NULL and the error line when it
 * cannot be made. */
rlf_world *eval_world_open(rlf_physics_method method, rlf_vec3 gravity, int32_t bodies);
/* State of the body that was added as number i. */
const rlf_body_state *eval_world_body(const rlf_world *world, int32_t i);

/* Bodies in empty space, both methods: fall, tumbling, a row of balls. */
rlf_result eval_free_run(eval_table *table, rlf_profile profile);
/* Bodies on still planes: stack, slope. */
rlf_result eval_rest_run(eval_table *table, eval_sheet *sheet);
/* Sensed boards and plates that move through bodies. */
rlf_result eval_push_run(eval_table *table, eval_sheet *sheet);
/* Random throws at a still room, at somebody's back and at a book's edge. */
rlf_result eval_throw_run(eval_table *table, eval_sheet *sheet, int64_t seed);

#endif
