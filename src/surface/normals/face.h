/* Two faces, each the plane through a pixel with its normal: where they lie, and how they meet. */
#ifndef RLF_SURFACE_NORMALS_FACE_H
#define RLF_SURFACE_NORMALS_FACE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct rlf_faces {
    const float *ray_x, *ray_y, *depth;
    float *const *normal;
} rlf_faces;

/* CONVEX: a ray meets the farther one; CONCAVE: the nearer one. */
typedef enum rlf_meeting { RLF_FACES_APART, RLF_FACES_CONVEX, RLF_FACES_CONCAVE } rlf_meeting;

/* Depth of the face through pixel `face` on the ray of pixel `at`; 0 where that does not meet it.
 */
static inline float rlf_face_depth(const rlf_faces *f, ptrdiff_t face, ptrdiff_t at)
{
    const float least_facing = 0.02f; /* a face may be seen edge-on, not from behind */
    float nx = f->normal[0][face], ny = f->normal[1][face], nz = f->normal[2][face];
    float offset = f->depth[face] * (nx * f->ray_x[face] + ny * f->ray_y[face] + nz);
    float facing = nx * f->ray_x[at] + ny * f->ray_y[at] + nz;
    return facing < -least_facing ? offset / facing : 0.0f;
}

/* Of the faces that pixels a and b are on. `a_at_b` is the depth of a's face at pixel b. */
static inline rlf_meeting rlf_faces_meet(float at_a, float b_at_a, float at_b, float a_at_b)
{
    bool convex = b_at_a > 0.0f && a_at_b > 0.0f && at_a > b_at_a && at_b > a_at_b;
    bool concave = (!(b_at_a > 0.0f) || at_a < b_at_a) && (!(a_at_b > 0.0f) || at_b < a_at_b);
    return convex ? RLF_FACES_CONVEX : (concave ? RLF_FACES_CONCAVE : RLF_FACES_APART);
}

#endif
