/* Where normals turn from one side of a pixel to the other, as they do about a crease. */
#include "kernel/kernel.h"

static const float least_bend = 0.9f;  /* cosine between the sides */
static const float most_slope = 0.16f; /* share of the depth from side to side: no edge between */

RLF_KERNEL_PART int32_t turns(const rlf_kernel_bend_in *a, int32_t i, const rlf_kernel_bend_in *b,
                              int32_t k)
{
    float cosine = a->normal[0][i] * b->normal[0][k] + a->normal[1][i] * b->normal[1][k] +
                   a->normal[2][i] * b->normal[2][k];
    float apart = rlf_kernel_abs(a->depth[i] - b->depth[k]);
    return (cosine < least_bend ? 1 : 0) & (apart < most_slope * a->depth[i] ? 1 : 0);
}

RLF_KERNEL void rlf_kernel_bend_row(const rlf_kernel_bend_in rows[3], int32_t count,
                                    uint8_t *restrict bend)
{
    enum { SPAN = RLF_KERNEL_BEND_SPAN };
    for (int32_t i = 0; i < count; i++) {
        bend[i] = (uint8_t)(RLF_BEND_DOWN * turns(&rows[0], i, &rows[2], i));
    }
    for (int32_t i = SPAN; i < count - SPAN; i++) {
        int32_t across = turns(&rows[1], i - SPAN, &rows[1], i + SPAN);
        bend[i] = (uint8_t)(bend[i] + RLF_BEND_ACROSS * across);
    }
}
