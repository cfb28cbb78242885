#include "kernel/kernel.h"

RLF_KERNEL
void rlf_kernel_body_mean_row(const float *const depth[3], const float *const value[3],
                              int32_t count, float jump, float *restrict out)
{
    for (int32_t x = 1; x < count - 1; x++) {
        float z = depth[1][x], sum = 0.0f, members = 0.0f;
        for (int32_t row = 0; row < 3; row++) {
            for (int32_t k = -1; k <= 1; k++) {
                float same = rlf_kernel_abs(depth[row][x + k] - z) < jump ? 1.0f : 0.0f;
                sum += same * value[row][x + k];
                members += same;
            }
        }
        out[x] = sum / members;
    }
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
