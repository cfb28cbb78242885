/* The outline that a surface ends at where its normal leans to: see surface/normals/turn.c. */
#include "kernel/outline.h"

#include <math.h>

enum { STEPS = RLF_LEAN_STEPS };

static const float most_step = 0.04f; /* share of the depth from pixel to pixel of one surface */
static const float least_lean = 0.1f; /* sine between ray and normal that has a direction */

/* Normals and rays of the pixels. */
typedef struct leaning {
    float nx[RLF_BATCH], ny[RLF_BATCH], nz[RLF_BATCH], rx[RLF_BATCH], ry[RLF_BATCH];
} leaning;

/* The places of a pixel's steps, -1 inwards, and the depths there. */
typedef struct lean_walk {
    int32_t x[STEPS + 2][RLF_BATCH], y[STEPS + 2][RLF_BATCH];
    float z[STEPS + 2][RLF_BATCH];
} lean_walk;

RLF_KERNEL_PART void read_pixels(const rlf_way *way, const rlf_way_from *restrict from,
                                 leaning *restrict out)
{
    const float *nx = way->normal[0], *ny = way->normal[1], *nz = way->normal[2];
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        ptrdiff_t i = (ptrdiff_t)from->y[k] * way->width + from->x[k];
        out->nx[k] = nx[i];
        out->ny[k] = ny[i];
        out->nz[k] = nz[i];
        out->rx[k] = way->ray_x[i];
        out->ry[k] = way->ray_y[i];
    }
}

/* Unit vectors in the image; 0 where the normal leans nowhere. */
RLF_KERNEL_PART void find_leans(const leaning *restrict at, rlf_outlines *restrict out)
{
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        float rx = at->rx[k], ry = at->ry[k], square = 1.0f + rx * rx + ry * ry;
        float along = (at->nx[k] * rx + at->ny[k] * ry + at->nz[k]) / square;
        float lean_x = at->nx[k] - along * rx, lean_y = at->ny[k] - along * ry;
        float lean = sqrtf(lean_x * lean_x + lean_y * lean_y);
        bool leans = lean > least_lean;
        float whole = leans ? lean : 1.0f;
        out->x[k] = leans ? lean_x / whole : 0.0f;
        out->y[k] = leans ? lean_y / whole : 0.0f;
    }
}

RLF_KERNEL_PART void walk(const rlf_way *way, const rlf_way_from *restrict from,
                          const rlf_outlines *restrict at, lean_walk *restrict out)
{
    for (int32_t s = 0; s < STEPS + 2; s++) {
        float steps = (float)(s - 1);
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < RLF_BATCH; k++) {
            out->x[s][k] = (int32_t)((float)from->x[k] + steps * at->x[k] + 0.5f);
            out->y[s][k] = (int32_t)((float)from->y[k] + steps * at->y[k] + 0.5f);
        }
        for (int32_t k = 0; k < RLF_BATCH; k++) {
            out->z[s][k] = way->depth[(ptrdiff_t)out->y[s][k] * way->width + out->x[s][k]];
        }
    }
}

RLF_KERNEL void rlf_kernel_lean_out(const rlf_way *way, const rlf_way_from *restrict from,
                                    rlf_outlines *restrict out)
{
    leaning at;
    lean_walk w;
    int32_t goes_on[RLF_BATCH];
    read_pixels(way, from, &at);
    find_leans(&at, out);
    walk(way, from, out, &w);
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        goes_on[k] = (out->x[k] != 0.0f) | (out->y[k] != 0.0f);
        out->distance[k] = 0.0f;
    }
    for (int32_t s = 2; s < STEPS + 2; s++) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < RLF_BATCH; k++) {
            float z = w.z[s][k], last = w.z[s - 1][k], rise = last - w.z[s - 2][k];
            int32_t is_end = z > rlf_outline_behind(last, RLF_OUTLINE_STEP_SEEN, rise) ? 1 : 0;
            int32_t is_near = rlf_kernel_abs(z - last) <= most_step * last ? 1 : 0;
            float distance = (float)(w.x[s][k] - from->x[k]) * out->x[k] +
                             (float)(w.y[s][k] - from->y[k]) * out->y[k] - 0.5f;
            out->distance[k] = (goes_on[k] & is_end) != 0 ? distance : out->distance[k];
            goes_on[k] &= is_near & (is_end ^ 1);
        }
    }
}
