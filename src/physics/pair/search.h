/* The pairs of bodies that are near each other, and their contacts. */
#ifndef RLF_PHYSICS_PAIR_SEARCH_H
#define RLF_PHYSICS_PAIR_SEARCH_H

#include "physics/world_state.h"

#define PHYS_PAIR_MARGIN 0.002 /* m beyond their way at which bodies are near */

/* Finds the pairs and searches the contacts of those that have moved. h: substep, s. Pairs live on
 * for PHYS_PERIOD_MAX substeps. */
void phys_find_pairs(rlf_world *world, double h);

/* Counts a substep and searches anew the contacts of fast pairs. */
void phys_refresh_pairs(rlf_world *world, double h);

/* Takes away the pairs of a body. */
void phys_drop_pairs(rlf_world *world, int32_t body);

#endif
