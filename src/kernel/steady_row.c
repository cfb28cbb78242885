/* Mean of a pixel's inverse depth over time, gated by the sensor's noise: what lies farther from
 * the mean than the gate is motion, and the mean starts anew with it. So a result is never farther
 * from the current frame than the gate: nothing that has left can stay. */
#include "kernel/kernel.h"

#include "relief/surface.h"

#include <math.h>

enum { CHUNK = 256 };

/* Depth of the pixels that were seen, 0 for others; apart, because bytes make longer vectors. */
RLF_KERNEL_PART void seen_depth(const float *restrict depth, const uint8_t *restrict reason,
                                int32_t count, float *restrict seen)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        int32_t why = reason[i];
        seen[i] = why == RLF_REASON_OK ? z : 0.0f;
    }
}

RLF_KERNEL_PART void steady_chunk(const rlf_kernel_steady params, const float *restrict nx,
                                  const float *restrict ny, const float *restrict nz,
                                  const float *restrict x, const float *restrict y,
                                  const float *restrict seen, int32_t count, float *restrict depth,
                                  float *restrict mean, float *restrict frames)
{
    for (int32_t i = 0; i < count; i++) {
        float old_mean = mean[i], old_frames = frames[i], old_depth = depth[i];
        bool is_seen = seen[i] > 0.0f;
        float w = 1.0f / (is_seen ? seen[i] : 1.0f);
        float facing = nx[i] * x[i] + ny[i] * y[i] + nz[i];
        float length = sqrtf(x[i] * x[i] + y[i] * y[i] + 1.0f);
        float slant = rlf_kernel_slant(facing < 0.0f ? -facing : length, length);
        float gate = params.sigmas * rlf_kernel_inverse_sigma(params.noise, w) * slant;
        bool is_same = rlf_kernel_abs(w - old_mean) <= gate;
        float n = (is_same ? rlf_kernel_abs(old_frames) : 0.0f) + 1.0f;
        n = n < params.most ? n : params.most;
        float next = is_same ? old_mean + (w - old_mean) / n : w;
        mean[i] = is_seen ? next : old_mean;
        frames[i] = is_seen ? n : old_frames;
        depth[i] = is_seen ? 1.0f / (is_seen ? next : 1.0f) : old_depth;
    }
}

RLF_KERNEL void rlf_kernel_steady_row(const rlf_kernel_steady *params,
                                      const rlf_kernel_steady_in *in, float *restrict depth,
                                      float *restrict mean, float *restrict frames)
{
    float seen[CHUNK];
    for (int32_t i = 0; i < in->count; i += CHUNK) {
        int32_t count = in->count - i < CHUNK ? in->count - i : CHUNK;
        seen_depth(depth + i, in->reason + i, count, seen);
        steady_chunk(*params, in->normal[0] + i, in->normal[1] + i, in->normal[2] + i,
                     in->ray_x + i, in->ray_y + i, seen, count, depth + i, mean + i, frames + i);
    }
}
