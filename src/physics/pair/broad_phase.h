/* Which bodies are near each other. */
#ifndef RLF_PHYSICS_PAIR_BROAD_PHASE_H
#define RLF_PHYSICS_PAIR_BROAD_PHASE_H

#include "physics/world_state.h"

/* Fills world->near_sorted, sorted by (a, b), with the bodies whose boxes may overlap within
 * `horizon` seconds; not those of which neither moves. */
void phys_find_near(rlf_world *world, double horizon);

#endif
