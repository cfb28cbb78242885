/* Where a face ends that a ball all but touches and another seen face begins: at an edge or a
 * corner. */
#ifndef RLF_PHYSICS_GRID_BALL_CORNER_H
#define RLF_PHYSICS_GRID_BALL_CORNER_H

#include "physics/grid/ball/patch.h"

#define CORNER_FACES 3

/* The solid behind all of these planes. */
typedef struct patch_corner {
    patch_plane faces[CORNER_FACES];
    int32_t count;
} patch_corner;

/* The faces of a patch that bend away from its face, where the place of their solid that is nearest
 * to the ball is seen. False where there are none, or where that place is on no seen face. */
bool corner_find(const grid_patch *p, const patch_mean *face, patch_corner *out);

/* The place of the solid that is nearest to `centre`, which is outside. */
rlf_vec3 corner_nearest(const patch_corner *corner, rlf_vec3 centre);

#endif
