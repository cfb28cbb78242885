/* Raw depth to metres with a reason for every pixel that has none. */
#include "kernel/kernel.h"

#include "relief/surface.h"

RLF_KERNEL_PART uint8_t reason_of(float z, rlf_kernel_range range)
{
    uint8_t reason = RLF_REASON_OK;
    reason = z < range.near_m ? (uint8_t)RLF_REASON_TOO_NEAR : reason;
    reason = z > range.far_m ? (uint8_t)RLF_REASON_TOO_FAR : reason;
    return reason;
}

RLF_KERNEL void rlf_kernel_depth_row_u16(const uint16_t *restrict source, int32_t step,
                                         int32_t count, rlf_kernel_range range,
                                         float *restrict depth, uint8_t *restrict reason)
{
    for (int32_t i = 0; i < count; i++) {
        uint16_t raw = source[(ptrdiff_t)i * step];
        float z = (float)raw * range.metres_per_unit;
        uint8_t why = raw == 0 ? (uint8_t)RLF_REASON_NO_RETURN : reason_of(z, range);
        reason[i] = why;
        depth[i] = why == RLF_REASON_OK ? z : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_depth_row_f32(const float *restrict source, int32_t step, int32_t count,
                                         rlf_kernel_range range, float *restrict depth,
                                         uint8_t *restrict reason)
{
    for (int32_t i = 0; i < count; i++) {
        float z = source[(ptrdiff_t)i * step];
        bool usable = z > 0.0f && z - z == 0.0f; /* false for NaN and infinity */
        uint8_t why = usable ? reason_of(z, range) : (uint8_t)RLF_REASON_NO_RETURN;
        reason[i] = why;
        depth[i] = why == RLF_REASON_OK ? z : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_lens_row(const uint8_t *restrict has_ray, int32_t count,
                                    float *restrict depth, uint8_t *restrict reason)
{
    for (int32_t i = 0; i < count; i++) {
        reason[i] = has_ray[i] ? reason[i] : (uint8_t)RLF_REASON_OUTSIDE_LENS;
        depth[i] = has_ray[i] ? depth[i] : 0.0f;
    }
}
