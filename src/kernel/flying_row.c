/* Flying pixels: a sample that mixes a near and a far surface hangs between them and has few
 * neighbours at its own depth. A pixel stays when at least 3 of its 8 neighbours are within
 * 1.2 % + 4 mm, or when at least 2 of the 4 opposite pairs are collinear with it (a steep plane).
 * A pair that spans a real jump is collinear with a mixed pixel by chance only, and is ruled out by
 * a limit on its slope. A column or row of mixed pixels supports itself; it is found by the two
 * levels that it lies between. */
#include "kernel/kernel.h"

#include "relief/surface.h"

RLF_KERNEL_PART int32_t is_close(float a, float z, float tolerance)
{
    return rlf_kernel_abs(a - z) <= tolerance ? 1 : 0;
}

RLF_KERNEL_PART int32_t is_collinear(float a, float b, float z, float tolerance)
{
    float slope_limit = 0.06f * z;
    int32_t straight = rlf_kernel_abs(a + b - 2.0f * z) <= tolerance ? 1 : 0;
    int32_t gentle = rlf_kernel_abs(a - z) <= slope_limit ? 1 : 0;
    return straight & gentle;
}

RLF_KERNEL_PART int32_t is_kept(const float n[8], float z)
{
    float tolerance = 0.012f * z + 0.004f;
    int32_t close = 0;
    for (int k = 0; k < 8; k++) {
        close += is_close(n[k], z, tolerance);
    }
    int32_t pairs = 0;
    for (int k = 0; k < 4; k++) {
        pairs += is_collinear(n[k], n[7 - k], z, tolerance);
    }
    return (close >= 3) | (pairs >= 2);
}

RLF_KERNEL_PART int32_t is_kept_at_border(const float *const rows[3], int32_t count, int32_t i)
{
    int32_t left = i > 0 ? i - 1 : i;
    int32_t right = i + 1 < count ? i + 1 : i;
    float inside_left = i > 0 ? 1.0f : 0.0f;
    float inside_right = i + 1 < count ? 1.0f : 0.0f;
    const float n[8] = {rows[0][left] * inside_left,
                        rows[0][i],
                        rows[0][right] * inside_right,
                        rows[1][left] * inside_left,
                        rows[1][right] * inside_right,
                        rows[2][left] * inside_left,
                        rows[2][i],
                        rows[2][right] * inside_right};
    return is_kept(n, rows[1][i]);
}

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

RLF_KERNEL_PART float kept_depth(float z, int32_t kept)
{
    return kept != 0 ? z : 0.0f;
}

/* Takes off what hangs half way between the pixels left and right of it, or above and below. */
RLF_KERNEL_PART void drop_half_way(const float *const rows[5], int32_t count, float *restrict depth)
{
    const float *restrict far_up = rows[0];
    const float *restrict up = rows[1];
    const float *restrict at = rows[2];
    const float *restrict down = rows[3];
    const float *restrict far_down = rows[4];
    for (int32_t i = 2; i < count - 2; i++) {
        int32_t across = is_half_way(at[i - 2], at[i - 1], at[i], at[i + 1], at[i + 2]);
        int32_t along = is_half_way(far_up[i], up[i], at[i], down[i], far_down[i]);
        depth[i] = kept_depth(depth[i], 1 - (across | along));
    }
}

RLF_KERNEL void rlf_kernel_flying_row(const float *const rows[5], int32_t count,
                                      float *restrict depth, uint8_t *restrict reason)
{
    const float *restrict up = rows[1];
    const float *restrict at = rows[2];
    const float *restrict down = rows[3];
    depth[0] = kept_depth(at[0], is_kept_at_border(rows + 1, count, 0));
    for (int32_t i = 1; i < count - 1; i++) {
        const float n[8] = {up[i - 1], up[i],       up[i + 1], at[i - 1],
                            at[i + 1], down[i - 1], down[i],   down[i + 1]};
        depth[i] = kept_depth(at[i], is_kept(n, at[i]));
    }
    if (count > 1) {
        depth[count - 1] = kept_depth(at[count - 1], is_kept_at_border(rows + 1, count, count - 1));
    }
    drop_half_way(rows, count, depth);
    for (int32_t i = 0; i < count; i++) { /* apart, because bytes would make longer vectors */
        uint8_t why = reason[i];
        int32_t is_flying = (at[i] > 0.0f) & !(depth[i] > 0.0f);
        reason[i] = is_flying != 0 ? (uint8_t)RLF_REASON_FLYING : why;
    }
}
