/* Raw depth to metres with a reason for every pixel that has none. */
#include "kernel/kernel.h"

#include "relief/surface.h"

/* As wide as depth, so that both are lanes of one vector. */
RLF_KERNEL_PART int32_t reason_of(float z, rlf_kernel_range range)
{
    int32_t reason = RLF_REASON_OK;
    reason = z < range.near_m ? (int32_t)RLF_REASON_TOO_NEAR : reason;
    reason = z > range.far_m ? (int32_t)RLF_REASON_TOO_FAR : reason;
    return reason;
}

/* z inside the range, otherwise 0; not asked of the reason, which would become a branch. */
RLF_KERNEL_PART float kept_depth(float z, rlf_kernel_range range)
{
    float kept = z < range.near_m ? 0.0f : z;
    return z > range.far_m ? 0.0f : kept;
}

RLF_KERNEL_PART void read_u16(const uint16_t *restrict source, int32_t step, int32_t count,
                              rlf_kernel_range range, float *restrict depth,
                              uint8_t *restrict reason)
{
    for (int32_t i = 0; i < count; i++) {
        int32_t raw = source[(ptrdiff_t)i * step];
        float z = (float)raw * range.metres_per_unit;
        int32_t why = reason_of(z, range);
        why = raw == 0 ? (int32_t)RLF_REASON_NO_RETURN : why;
        reason[i] = (uint8_t)why;
        depth[i] = kept_depth(z, range);
    }
}

/* With the constant step 1 the loop needs no gathering. */
RLF_KERNEL void rlf_kernel_depth_row_u16(const uint16_t *restrict source, int32_t step,
                                         int32_t count, rlf_kernel_range range,
                                         float *restrict depth, uint8_t *restrict reason)
{
    if (step == 1) {
        read_u16(source, 1, count, range, depth, reason);
    } else {
        read_u16(source, step, count, range, depth, reason);
    }
}

RLF_KERNEL void rlf_kernel_depth_row_f32(const float *restrict source, int32_t step, int32_t count,
                                         rlf_kernel_range range, float *restrict depth,
                                         uint8_t *restrict reason)
{
    for (int32_t i = 0; i < count; i++) {
        float z = source[(ptrdiff_t)i * step];
        bool usable = (z > 0.0f) & (z - z == 0.0f); /* false for NaN and infinity */
        int32_t why = reason_of(z, range);
        why = usable ? why : (int32_t)RLF_REASON_NO_RETURN;
        reason[i] = (uint8_t)why;
        depth[i] = usable ? kept_depth(z, range) : 0.0f;
    }
}

RLF_KERNEL void rlf_kernel_lens_row(const uint8_t *restrict has_ray, int32_t count,
                                    float *restrict depth, uint8_t *restrict reason)
{
    for (int32_t i = 0; i < count; i++) {
        uint8_t why = reason[i];
        reason[i] = has_ray[i] != 0 ? why : (uint8_t)RLF_REASON_OUTSIDE_LENS;
    }
    for (int32_t i = 0; i < count; i++) {
        float z = depth[i];
        int32_t is_inside = has_ray[i];
        depth[i] = is_inside != 0 ? z : 0.0f;
    }
}
