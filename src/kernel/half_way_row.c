/* A column or row of mixed pixels supports itself, so that its neighbours do not give it away
 * (flying_row.c); the two levels that it lies between do. */
#include "kernel/kernel.h"

#include "relief/surface.h"

/* Half way between two levels: the steps to both sides are longer than noise makes them (it grows
 * with z^2), alike within a factor of 5, and twice as long as those beyond them. A steep plane goes
 * on as it is, and the rim of a round body is far nearer to the body than to what is behind it. */
RLF_KERNEL_PART int32_t is_half_way(float before, float left, float z, float right, float beyond)
{
    float tolerance = 0.0025f * z * z + 0.003f;
    float down = left - z, up = z - right;
    float down_size = rlf_kernel_abs(down), up_size = rlf_kernel_abs(up);
    float least = down_size < up_size ? down_size : up_size;
    int32_t one_way = down * up > 0.0f ? 1 : 0;
    int32_t long_steps = least > tolerance ? 1 : 0;
    int32_t alike = down_size + up_size < 6.0f * least ? 1 : 0;
    int32_t level_left = 2.0f * rlf_kernel_abs(before - left) < least ? 1 : 0;
    int32_t level_right = 2.0f * rlf_kernel_abs(beyond - right) < least ? 1 : 0;
    return one_way & long_steps & alike & level_left & level_right;
}

/* Left and right of a pixel, or above and below. */
RLF_KERNEL void rlf_kernel_half_way_row(const float *const rows[5], int32_t begin, int32_t end,
                                        float *restrict depth, uint8_t *restrict reason)
{
    const float *restrict far_up = rows[0];
    const float *restrict up = rows[1];
    const float *restrict at = rows[2];
    const float *restrict down = rows[3];
    const float *restrict far_down = rows[4];
    for (int32_t i = begin; i < end; i++) {
        int32_t across = is_half_way(at[i - 2], at[i - 1], at[i], at[i + 1], at[i + 2]);
        int32_t along = is_half_way(far_up[i], up[i], at[i], down[i], far_down[i]);
        depth[i] = (across | along) != 0 ? 0.0f : depth[i];
    }
    for (int32_t i = begin; i < end; i++) { /* apart, because bytes would make longer vectors */
        uint8_t why = reason[i];
        int32_t is_flying = (at[i] > 0.0f) & !(depth[i] > 0.0f);
        reason[i] = is_flying != 0 ? (uint8_t)RLF_REASON_FLYING : why;
    }
}
