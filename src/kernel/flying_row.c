/* Flying pixels: a sample that mixes a near and a far surface hangs between them and has few
 * neighbours at its own depth. A pixel stays when at least 3 of its 8 neighbours are within
 * 1.2 % + 4 mm, or when at least 2 of the 4 opposite pairs are collinear with it (a steep plane).
 * A pair that spans a real jump is collinear with a mixed pixel by chance only, and is ruled out by
 * a limit on its slope. */
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

RLF_KERNEL_PART float kept_depth(float z, int32_t kept)
{
    return kept != 0 ? z : 0.0f;
}

RLF_KERNEL void rlf_kernel_flying_row(const float *const rows[3], int32_t count,
                                      float *restrict depth, uint8_t *restrict reason)
{
    const float *restrict up = rows[0];
    const float *restrict at = rows[1];
    const float *restrict down = rows[2];
    depth[0] = kept_depth(at[0], is_kept_at_border(rows, count, 0));
    for (int32_t i = 1; i < count - 1; i++) {
        const float n[8] = {up[i - 1], up[i],       up[i + 1], at[i - 1],
                            at[i + 1], down[i - 1], down[i],   down[i + 1]};
        depth[i] = kept_depth(at[i], is_kept(n, at[i]));
    }
    if (count > 1) {
        depth[count - 1] = kept_depth(at[count - 1], is_kept_at_border(rows, count, count - 1));
    }
    for (int32_t i = 0; i < count; i++) { /* apart, because bytes would make longer vectors */
        uint8_t why = reason[i];
        int32_t is_flying = (at[i] > 0.0f) & !(depth[i] > 0.0f);
        reason[i] = is_flying != 0 ? (uint8_t)RLF_REASON_FLYING : why;
    }
}
