/* How many of a region's pixels are where they were: see surface/motion/rigid.c. What rests
 * stays on its ray, and its slope has no say. */
#include "kernel/flow.h"

#include "relief/surface.h"

enum { LANES = 16 };

typedef struct rest_counts {
    int32_t phase[LANES]; /* columns since the last that is looked at */
    int32_t samples[LANES], inliers[LANES];
} rest_counts;

RLF_KERNEL_PART int32_t was_sensed(const rlf_kernel_rest_in *in, ptrdiff_t i)
{
    return in->reason[i] == RLF_REASON_OK ? 1 : 0;
}

RLF_KERNEL_PART int32_t rests(const rlf_kernel_rest_in *in, ptrdiff_t i)
{
    float x = in->ray_x[i], y = in->ray_y[i], z = in->depth[i], before = in->before[i];
    float step = z - before;
    float facing = -(in->normal[0][i] * x + in->normal[1][i] * y + in->normal[2][i]);
    float bound = 3.0f * 1.41421356f * rlf_kernel_sigma(in->noise, z);
    return (facing > 0.0f) & (before > 0.0f) & (step <= bound) & (step >= -bound) &
           (step * step * (x * x + y * y + 1.0f) < in->reach * in->reach);
}

/* Pixels from the i-th on, `room` of which are in the region's rectangle. */
RLF_KERNEL_PART void count_lanes(const rlf_kernel_rest_in *in, ptrdiff_t i, int32_t room,
                                 rest_counts *restrict c)
{
    int32_t stride = in->stride, shift = LANES % stride, sensed[LANES];
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < LANES; k++) { /* apart: with bytes lanes are shorter */
        sensed[k] = was_sensed(in, i + k);
    }
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < LANES; k++) {
        int32_t is = (c->phase[k] == 0) & (k < room) & (in->label[i + k] == in->own) & sensed[k];
        c->samples[k] += is;
        c->inliers[k] += is & rests(in, i + k);
        int32_t next = c->phase[k] + shift;
        c->phase[k] = next - (next >= stride ? stride : 0);
    }
}

RLF_KERNEL_PART void count_row(const rlf_kernel_rest_in *in, int32_t y, rest_counts *restrict c)
{
    ptrdiff_t row = (ptrdiff_t)y * in->width;
    int32_t x = in->x0;
    for (; x < in->x1 && x + LANES <= in->width; x += LANES) {
        count_lanes(in, row + x, in->x1 - x, c);
    }
    for (; x < in->x1; x++) { /* at the image's right side */
        bool is_looked_at = (x - in->x0) % in->stride == 0 && in->label[row + x] == in->own;
        int32_t is = is_looked_at ? was_sensed(in, row + x) : 0;
        c->samples[0] += is;
        c->inliers[0] += is & rests(in, row + x);
    }
}

RLF_KERNEL void rlf_kernel_rest_count(const rlf_kernel_rest_in *in, int32_t *samples,
                                      int32_t *inliers)
{
    const rlf_kernel_rest_in copy = *in;
    rest_counts c = {{0}, {0}, {0}};
    int32_t phase[LANES];
    for (int32_t k = 0, p = 0; k < LANES; k++) {
        phase[k] = p;
        p = p + 1 < copy.stride ? p + 1 : 0;
    }
    for (int32_t y = copy.y0; y < copy.y1; y += copy.stride) {
        memcpy(c.phase, phase, sizeof phase);
        count_row(&copy, y, &c);
    }
    *samples = *inliers = 0;
    for (int32_t k = 0; k < LANES; k++) {
        *samples += c.samples[k];
        *inliers += c.inliers[k];
    }
}
