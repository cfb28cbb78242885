/* Planes in a patch's points: normals beside an edge are means over both of its faces. */
#ifndef RLF_PHYSICS_GRID_PLANE_H
#define RLF_PHYSICS_GRID_PLANE_H

#include "physics/grid/patch.h"

typedef struct patch_plane {
    rlf_vec3 normal, point;
    double support; /* samples on it */
} patch_plane;

#define PLANE_NEAR 0.008 /* metres: a plane through q, up to noise */

/* The plane that passes q no farther off than `near` metres and holds most samples, of those that
 * bend away from all `count` normals of `others`, and hold a direction `along` (0: any). False when
 * too few samples say. */
bool plane_find(const grid_patch *p, rlf_vec3 q, double near, const rlf_vec3 *others, int32_t count,
                rlf_vec3 along, patch_plane *out);

/* Whether the sample is on the plane, up to noise. */
bool plane_holds(const patch_plane *plane, const patch_sample *s);

#endif
