/* From the knots at every second pixel to all pixels: see surface/thickness/knots.c. */
#include "kernel/kernel.h"

#include <math.h>

/* What is straight from knot to knot, averaged over three pixels about a knot, and over three about
 * the middle between two knots. */
static const float about_knot[3] = {1.0f, 4.0f, 1.0f}, about_middle[3] = {0.0f, 3.0f, 3.0f};

RLF_KERNEL_PART void spread(const rlf_kernel_knots knots, const float columns[3], int32_t first,
                            int32_t count, float jump, const float *restrict depth,
                            float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i], sum = 0.0f, members = 0.0f;
        for (int32_t row = 0; row < 3; row++) {
            for (int32_t k = first; k < 2; k++) {
                float there = knots.depth[row][i + k], value = knots.value[row][i + k];
                bool is_same = rlf_kernel_abs(there - z) < jump;
                bool is_behind = rlf_kernel_abs(there) >= z + jump;
                float weight = is_same || is_behind ? knots.weight[row] * columns[k + 1] : 0.0f;
                sum += is_same ? weight * value * value : 0.0f;
                members += weight;
            }
        }
        out[i] = sqrtf(sum / (members > 0.0f ? members : 1.0f));
    }
}

RLF_KERNEL void rlf_kernel_spread_row(const rlf_kernel_knots *in, int32_t count, float jump,
                                      const float *restrict at, const float *restrict right,
                                      float *restrict out_at, float *restrict out_right)
{
    spread(*in, about_knot, -1, count, jump, at, out_at);
    spread(*in, about_middle, 0, count, jump, right, out_right);
}
