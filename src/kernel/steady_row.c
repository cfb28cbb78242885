/* Mean of a pixel's inverse depth over time, gated by the sensor's noise: what lies farther from
 * the mean than the gate is motion, and the mean starts anew with it. So a result is never farther
 * from the current frame than the gate: nothing that has left can stay. */
#include "kernel/kernel.h"

#include "relief/surface.h"

#include <math.h>

RLF_KERNEL void rlf_kernel_steady_row(const rlf_kernel_steady *params,
                                      const rlf_kernel_steady_in *in, float *restrict depth,
                                      float *restrict mean, float *restrict frames)
{
    const float *restrict nx = in->normal[0];
    const float *restrict ny = in->normal[1];
    const float *restrict nz = in->normal[2];
    const float *restrict x = in->ray_x;
    const float *restrict y = in->ray_y;
    const uint8_t *restrict reason = in->reason;
    for (int32_t i = 0; i < in->count; i++) {
        float z = depth[i];
        bool is_seen = reason[i] == RLF_REASON_OK && z > 0.0f;
        float w = 1.0f / (is_seen ? z : 1.0f);
        float facing = nx[i] * x[i] + ny[i] * y[i] + nz[i];
        float length = sqrtf(x[i] * x[i] + y[i] * y[i] + 1.0f);
        float slant = rlf_kernel_slant(facing < 0.0f ? -facing : length, length);
        float gate = params->sigmas * rlf_kernel_inverse_sigma(params->noise, w) * slant;
        bool is_same = rlf_kernel_abs(w - mean[i]) <= gate;
        float n = (is_same ? rlf_kernel_abs(frames[i]) : 0.0f) + 1.0f;
        n = n < params->most ? n : params->most;
        float next = is_same ? mean[i] + (w - mean[i]) / n : w;
        mean[i] = is_seen ? next : mean[i];
        frames[i] = is_seen ? n : frames[i];
        depth[i] = is_seen ? 1.0f / (is_seen ? next : 1.0f) : z;
    }
}
