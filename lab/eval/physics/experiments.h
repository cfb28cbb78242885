/* The experiments of physics.c, by what they need. */
#ifndef RELIEF_APP_EVAL_PHYSICS_EXPERIMENTS_H
#define RELIEF_APP_EVAL_PHYSICS_EXPERIMENTS_H

#include "eval/physics/sheet.h"
#include "eval/table.h"

/* Bodies in empty space, both methods: fall, tumbling, a row of balls. */
rlf_result eval_free_run(eval_table *table, rlf_profile profile);
/* Bodies on still planes: stack, slope. */
rlf_result eval_rest_run(eval_table *table, eval_sheet *sheet);
/* Sensed boards and plates that move through bodies. */
rlf_result eval_push_run(eval_table *table, eval_sheet *sheet);
/* Random throws at a still room, at somebody's back and at a book's edge. */
rlf_result eval_throw_run(eval_table *table, eval_sheet *sheet, int64_t seed);

#endif
