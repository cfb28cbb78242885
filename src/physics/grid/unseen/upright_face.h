/* What stands goes on downwards behind what hides it: a column behind a table. */
#ifndef RLF_PHYSICS_GRID_UNSEEN_UPRIGHT_FACE_H
#define RLF_PHYSICS_GRID_UNSEEN_UPRIGHT_FACE_H

#include "physics/grid/unseen/room_planes.h"

/* The plane of the background's upright face under which q is: going up from q, the face is what
 * the camera sees first, past whatever hides it, within `reach` of q. `up` is a unit vector. Grid
 * frame. False when there is none. */
bool upright_face_find(const rlf_grid *grid, rlf_vec3 q, rlf_vec3 up, double reach,
                       room_plane *out);

#endif
