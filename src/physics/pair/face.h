/* The faces with which bodies touch. */
#ifndef RLF_PHYSICS_PAIR_FACE_H
#define RLF_PHYSICS_PAIR_FACE_H

#include "physics/body.h"

/* A hull's face with more corners keeps some of them, evenly. */
#define PAIR_FACE_MAX 16

/* What of a body's core is outermost in a direction, world frame: nothing (0 corners), the 2 of an
 * edge, or a convex polygon, counter-clockwise seen from outside. */
typedef struct pair_face {
    rlf_vec3 corner[PAIR_FACE_MAX];
    int32_t count;
    rlf_vec3 normal; /* unit, outward; of polygons */
    double rounding; /* the surface is so far outside of the corners, metres */
} pair_face;

/* The face that looks most along the unit direction `out`, whether it touches or not. */
void pair_face_of(const phys_body *body, rlf_vec3 out, pair_face *face);

#endif
