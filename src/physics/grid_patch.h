/* The pixels about the place where a ball touches a sheet. */
#ifndef RLF_PHYSICS_GRID_PATCH_H
#define RLF_PHYSICS_GRID_PATCH_H

#include "physics/grid_scan.h"

#define PATCH_PX 6 /* a patch has at most 2 x 6 + 1 samples a side */

/* A pixel of the patch: its point on the touched face when the ball is there, its distance. */
typedef struct patch_sample {
    field_cell cell;
    rlf_vec3 point;
    double distance; /* of the point to the ball's surface */
} patch_sample;

typedef struct grid_patch {
    const grid_job *job;
    grid_face face;
    int32_t x, y, step;
    double time;
    rlf_vec3 centre;                                        /* the ball's, at that time */
    int32_t index[(2 * PATCH_PX + 1) * (2 * PATCH_PX + 1)]; /* row by row: sample + 1, 0 = none */
    patch_sample samples[(2 * PATCH_PX + 1) * (2 * PATCH_PX + 1)];
    int32_t count, nearest;
} grid_patch;

/* What the weighted pixels of a patch say. */
typedef struct patch_mean {
    rlf_vec3 point, normal, velocity;
    double curvature; /* 1/m, above 0 for a bulge; 0 for a plane and a hollow */
    double spread2;   /* mean square distance from the mean point, m^2 */
} patch_mean;

/* Whether a pixel's normal is that of the face, up to noise and its curvature. */
static inline bool patch_is_of_face(rlf_vec3 normal, rlf_vec3 face)
{
    return rlf_dot(normal, face) > 0.8;
}

/* The point of the face under the ball's centre. */
rlf_vec3 patch_foot(const grid_patch *p, const patch_mean *mean);

/* The point nearest to the foot on the line where the face ends, of a face that ends before it. */
rlf_vec3 patch_edge(const grid_patch *p, const patch_mean *mean);

#endif
