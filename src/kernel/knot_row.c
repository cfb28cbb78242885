/* What chords are cut in: see surface/thickness/knots.c. */
#include "kernel/kernel.h"

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
