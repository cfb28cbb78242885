/* What stands at the picture's lower edge goes on below it: a table's leg, whose foot is out of
 * view. A body there meets what it would meet if it were lifted into view. */
#ifndef RLF_PHYSICS_GRID_BELOW_H
#define RLF_PHYSICS_GRID_BELOW_H

#include "physics/grid/scan.h"

/* How far a body about q (grid frame) must be lifted until all of it is in view, metres; 0 when q
 * is in view, or nothing is in view close above it. */
double grid_below_rise(const grid_query *query, rlf_vec3 q, double radius);

/* Whether the touch of a lifted body is one with something that stands, down to where the picture
 * ends. */
bool grid_below_stands(const grid_query *query, const grid_hit *hit);

#endif
