/* The way in from an outline: what is known of a surface, step by step. */
#ifndef RLF_SURFACE_NORMALS_WAY_H
#define RLF_SURFACE_NORMALS_WAY_H

#include "kernel/outline.h"

#include <stddef.h>

/* Planes that are read on the way. */
typedef struct rlf_way {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const uint8_t *known; /* 1 where depth was not filled */
    float *const *normal;
} rlf_way;

/* Writes samples of lane k from pixel (x, y) inwards, the first so many steps in, as far as the
 * surface goes on; not whether it moves. Returns the last pixel that is still of the surface. */
static inline ptrdiff_t rlf_way_read(const rlf_way *way, int32_t x, int32_t y,
                                     const rlf_outlines *at, int32_t k, int32_t first,
                                     rlf_way_in *restrict in)
{
    const float most_apart = 0.05f; /* share of the depth, of samples of one surface */
    ptrdiff_t start = (ptrdiff_t)y * way->width + x, inner = start;
    float z = way->depth[start], out_x = at->x[k], out_y = at->y[k];
    float goes_on = 1.0f;
    for (int32_t step = 0; step < RLF_OUTLINE_STEPS; step++) {
        float steps = (float)(step + first);
        int32_t sx = (int32_t)((float)x - steps * out_x + 0.5f);
        int32_t sy = (int32_t)((float)y - steps * out_y + 0.5f);
        bool inside = (sx >= 0) & (sy >= 0) & (sx < way->width) & (sy < way->height);
        ptrdiff_t i = inside ? (ptrdiff_t)sy * way->width + sx : start;
        bool near = rlf_kernel_abs(way->depth[i] - z) <= most_apart * z;
        goes_on = (inside & near) ? goes_on : 0.0f;
        inner = goes_on > 0.0f ? i : inner;
        float weight = way->known[i] != 0 ? goes_on : 0.0f;
        in->s[step][k] = at->distance[k] + (float)(x - sx) * out_x + (float)(y - sy) * out_y;
        in->normal[step].x[k] = weight * way->normal[0][i];
        in->normal[step].y[k] = weight * way->normal[1][i];
        in->normal[step].z[k] = weight * way->normal[2][i];
    }
    in->ray_x[k] = way->ray_x[start];
    in->ray_y[k] = way->ray_y[start];
    return inner;
}

#endif
