/* A world of its own for an experiment. */
#ifndef RELIEF_APP_EVAL_PHYSICS_WORLD_H
#define RELIEF_APP_EVAL_PHYSICS_WORLD_H

#include "relief/world.h"

/* A world without a border; its bodies are added by the caller. NULL and the error line when it
 * cannot be made. */
rlf_world *eval_world_open(rlf_physics_method method, rlf_vec3 gravity, int32_t bodies);
/* State of the body that was added as number i. */
const rlf_body_state *eval_world_body(const rlf_world *world, int32_t i);

#endif
