/* Flying pixels: a sample that mixes a near and a far surface hangs between them and has few
 * neighbours at its own depth. A pixel stays when at least 3 of its 8 neighbours are within
 * 1.2 % + 4 mm, or when at least 2 of the 4 opposite pairs are collinear with it (a steep plane).
 * A pair that spans a real jump is collinear with a mixed pixel by chance only, and is ruled out by
 * a limit on its slope. */
#include "kernel/kernel.h"

#include "relief/surface.h"

enum { CHUNK = 16 };

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

RLF_KERNEL_PART float tolerance_at(float z)
{
    return 0.012f * z + 0.004f;
}

RLF_KERNEL_PART int32_t is_beside_many(const float n[8], float z)
{
    int32_t close = 0;
    for (int k = 0; k < 8; k++) {
        close += is_close(n[k], z, tolerance_at(z));
    }
    return close >= 3 ? 1 : 0;
}

RLF_KERNEL_PART int32_t is_kept(const float n[8], float z)
{
    int32_t pairs = 0;
    for (int k = 0; k < 4; k++) {
        pairs += is_collinear(n[k], n[7 - k], z, tolerance_at(z));
    }
    return is_beside_many(n, z) | (pairs >= 2);
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

RLF_KERNEL_PART void mark_flying(const float *restrict at, int32_t begin, int32_t end,
                                 const float *restrict depth, uint8_t *restrict reason)
{
    for (int32_t i = begin; i < end; i++) { /* apart, because bytes would make longer vectors */
        uint8_t why = reason[i];
        int32_t is_flying = (at[i] > 0.0f) & !(depth[i] > 0.0f);
        reason[i] = is_flying != 0 ? (uint8_t)RLF_REASON_FLYING : why;
    }
}

/* The eight about pixel i of the middle row. */
RLF_KERNEL_PART void read_about(const float *const rows[3], int32_t i, float n[8])
{
    const float *up = rows[0], *at = rows[1], *down = rows[2];
    n[0] = up[i - 1], n[1] = up[i], n[2] = up[i + 1], n[3] = at[i - 1];
    n[4] = at[i + 1], n[5] = down[i - 1], n[6] = down[i], n[7] = down[i + 1];
}

/* Whether pixels i .. i + CHUNK - 1 are all empty or kept for their neighbours' sake, as most are.
 */
RLF_KERNEL_PART bool are_many(const float *const rows[3], int32_t i)
{
    int32_t many = 1;
    RLF_KERNEL_WHOLE
    for (int32_t k = i; k < i + CHUNK; k++) {
        float n[8], z = rows[1][k];
        read_about(rows, k, n);
        many &= is_beside_many(n, z) | (z > 0.0f ? 0 : 1);
    }
    return many != 0;
}

RLF_KERNEL_PART void drop_flying(const float *const rows[3], int32_t begin, int32_t end,
                                 float *restrict depth, uint8_t *restrict reason)
{
    for (int32_t i = begin; i < end; i++) {
        float n[8];
        read_about(rows, i, n);
        depth[i] = kept_depth(rows[1][i], is_kept(n, rows[1][i]));
    }
    mark_flying(rows[1], begin, end, depth, reason);
}

RLF_KERNEL void rlf_kernel_flying_row(const float *const rows[3], int32_t count,
                                      float *restrict depth, uint8_t *restrict reason)
{
    const float *at = rows[1];
    int32_t last = count - 1;
    for (int32_t i = 1; i < last; i += CHUNK) {
        int32_t end = i + CHUNK < last ? i + CHUNK : last;
        int32_t begin = end - CHUNK > 0 ? end - CHUNK : i; /* the last overlaps the one before it */
        if (end == begin + CHUNK && are_many(rows, begin)) {
            memcpy(depth + begin, at + begin, CHUNK * sizeof *depth);
        } else {
            drop_flying(rows, begin, end, depth, reason);
        }
    }
    depth[0] = kept_depth(at[0], is_kept_at_border(rows, count, 0));
    mark_flying(at, 0, 1, depth, reason);
    if (count > 1) {
        depth[last] = kept_depth(at[last], is_kept_at_border(rows, count, last));
        mark_flying(at, last, count, depth, reason);
    }
}
