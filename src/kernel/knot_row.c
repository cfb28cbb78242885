/* Between pixels and knots: see surface/thickness/knots.c. */
#include "kernel/kernel.h"

#include <math.h>

RLF_KERNEL void rlf_kernel_chord_front(const float *restrict raw, const float *restrict depth,
                                       int32_t label, int32_t count, float *restrict front,
                                       float *restrict inverse, int32_t *restrict labels)
{
    for (int32_t i = 0; i < count; i++) {
        bool is_seen = raw[i] > 0.0f;
        float one = 1.0f / (is_seen ? raw[i] : 1.0f);
        front[i] = depth[i];
        inverse[i] = is_seen ? one : 0.0f;
        labels[i] = label;
    }
}

RLF_KERNEL_PART float knot_of(float front, float depth)
{
    return front > 0.0f ? front : -depth;
}

RLF_KERNEL void rlf_kernel_knot_row(const float *restrict front, const float *restrict depth,
                                    int32_t step, int32_t count, float *restrict knot)
{
    if (step == 2) {
        for (int32_t k = 0; k < count; k++) {
            knot[k] = knot_of(front[2 * k], depth[2 * k]);
        }
        return;
    }
    for (int32_t k = 0; k < count; k++) {
        knot[k] = knot_of(front[step * k], depth[step * k]);
    }
}

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

RLF_KERNEL void rlf_kernel_thickness_row(const rlf_kernel_thickness *limits,
                                         const float *restrict depth, const float *restrict behind,
                                         int32_t count, float *restrict thickness)
{
    float least = limits->least, most = limits->most;
    for (int32_t i = 0; i < count; i++) {
        float t = thickness[i] < least ? least : thickness[i];
        t = t < most ? t : most;
        float room = behind[i] > depth[i] ? behind[i] - depth[i] : 0.0f;
        float limited = t > room ? room : t;
        thickness[i] = behind[i] > 0.0f ? limited : t;
    }
}
