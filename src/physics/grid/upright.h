/* What stands goes on downwards behind what hides it: a column behind a table. */
#ifndef RLF_PHYSICS_GRID_UPRIGHT_H
#define RLF_PHYSICS_GRID_UPRIGHT_H

#include "physics/grid/shell.h"

/* The plane of the background's upright face under which q is: going up from q, it is what the
 * camera sees first, past whatever hides it, within `reach` of q. `up` is a unit vector. Grid
 * frame. False when there is none. */
bool grid_upright_find(const rlf_grid *grid, rlf_vec3 q, rlf_vec3 up, double reach,
                       shell_plane *out);

#endif
