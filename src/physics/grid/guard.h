/* The last defence against tunnelling. */
#ifndef RLF_PHYSICS_GRID_GUARD_H
#define RLF_PHYSICS_GRID_GUARD_H

#include "physics/grid/collide.h"

/* Keeps the centre out of the surface: if the way from `before` enters a sheet through a face that
 * the body moves into, it goes back, along with the sheet, and bounces with its restitution and
 * friction. That blow is one of its contacts, which are to be searched again. */
void grid_guard_centre(const grid_query *query, phys_body *body, int32_t body_index,
                       rlf_vec3 before);

#endif
