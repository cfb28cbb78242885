/* Which bodies are near each other, and their contacts. */
#ifndef RLF_PHYSICS_BROAD_PHASE_H
#define RLF_PHYSICS_BROAD_PHASE_H

#include "physics/world_state.h"

/* Rebuilds world->pairs with contacts that stay good for `horizon` seconds; impulses of contacts
 * that live on are kept. */
void phys_find_pairs(rlf_world *world, double horizon);

#endif
