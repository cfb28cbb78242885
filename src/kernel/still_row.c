/* How long what stands before the background has not moved: see surface/background/absorb.c. */
#include "kernel/kernel.h"

enum { CHUNK = 64, STILL_WEIGHT = RLF_STILL_WEIGHT };

/* By how far the depth of what is still may be off. */
RLF_KERNEL_PART void find_gates(const rlf_kernel_still p, const float *restrict depth,
                                int32_t count, float *restrict gate)
{
    for (int32_t i = 0; i < count; i++) {
        double z = depth[i], sigma = p.noise.c0 + z * (p.noise.c1 + z * p.noise.c2);
        float scaled = (float)(p.sigmas * (sigma > 0.0003 ? sigma : 0.0003));
        gate[i] = scaled > p.least ? scaled : p.least;
    }
}

RLF_KERNEL_PART void follow(const rlf_kernel_still p, const uint8_t *restrict front,
                            const float *restrict depth, const float *restrict gate, int32_t count,
                            float *restrict still, uint16_t *restrict still_ms,
                            uint8_t *restrict is_due)
{
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i], off = z - still[i];
        int32_t ms = still_ms[i], age = ms + p.passed_ms;
        bool is_front = front[i] != 0, is_new = (ms == 0) | (rlf_kernel_abs(off) > gate[i]);
        float mean = still[i] + off / (float)STILL_WEIGHT;
        int32_t aged = age > p.limit_ms ? p.limit_ms : age, gone = z > 0.0f ? 0 : ms;
        mean = is_new ? z : mean;
        aged = is_new ? 1 : aged;
        is_due[i] = (is_front ? 1 : 0) & (is_new ? 0 : 1) & (age >= p.limit_ms ? 1 : 0);
        still[i] = is_front ? mean : still[i];
        still_ms[i] = (uint16_t)(is_front ? aged : gone);
    }
}

RLF_KERNEL void rlf_kernel_still_row(const rlf_kernel_still *p, const uint8_t *restrict front,
                                     const float *restrict depth, int32_t count,
                                     float *restrict still, uint16_t *restrict still_ms,
                                     uint8_t *restrict is_due)
{
    float gate[CHUNK];
    for (int32_t i = 0; i < count; i += CHUNK) {
        int32_t n = count - i < CHUNK ? count - i : CHUNK;
        find_gates(*p, depth + i, n, gate);
        follow(*p, front + i, depth + i, gate, n, still + i, still_ms + i, is_due + i);
    }
}
