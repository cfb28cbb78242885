/* Faces by their normals: how they are seen, and whether two are one. */
#ifndef RLF_SURFACE_BACKGROUND_FACING_H
#define RLF_SURFACE_BACKGROUND_FACING_H

#include "surface/stage.h"

static const float rlf_one_face = 0.94f;     /* cosine: 20 degrees */
static const float rlf_least_facing = 0.02f; /* a face may be seen edge-on, not from behind */

static inline void rlf_read_normal(float *const plane[3], ptrdiff_t i, float out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = plane[k][i];
    }
}

static inline float rlf_cosine(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Along the ray of pixel i, whose z is 1; < 0 where it faces the camera. */
static inline float rlf_facing(const rlf_grid *grid, const float normal[3], ptrdiff_t i)
{
    return normal[0] * grid->ray_x[i] + normal[1] * grid->ray_y[i] + normal[2];
}

#endif
