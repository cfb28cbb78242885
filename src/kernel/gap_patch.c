/* Gaps between pixels with depth: see surface/depth/fill.c. */
#include "kernel/batch.h"

enum { DIAGONAL_GAP = 4 }; /* a wide hole must not be crossed from corner to corner */

/* Copies bytes first .. first + count - 1 of a row of `size` bytes, 0 where it has none. */
static void copy_part(const uint8_t *row, int32_t size, int32_t first, int32_t count, uint8_t *out)
{
    int32_t begin = first < 0 ? -first : 0, end = size - first < count ? size - first : count;
    memset(out, 0, (size_t)count);
    memcpy(out + begin, row + first + begin, (size_t)(end - begin));
}

RLF_KERNEL void rlf_kernel_has_row(const float *restrict depth, int32_t count,
                                   uint8_t *restrict has)
{
    for (int32_t i = 0; i < count; i++) {
        has[i] = depth[i] > 0.0f ? 1 : 0;
    }
}

void rlf_gap_patch_read(const uint8_t *plane, int32_t width, int32_t height, int32_t x, int32_t y,
                        rlf_gap_patch *restrict out)
{
    bool inside = x >= RLF_FILL_GAP && x + RLF_BATCH + RLF_FILL_GAP <= width;
    for (int32_t k = 0; k < RLF_GAP_HEIGHT; k++) {
        int32_t row = y - RLF_FILL_GAP + k;
        const uint8_t *from = plane + (ptrdiff_t)row * width;
        if (row < 0 || row >= height) {
            memset(out->has[k], 0, sizeof out->has[k]);
        } else if (inside) {
            memcpy(out->has[k], from + x - RLF_FILL_GAP, sizeof out->has[k]);
        } else {
            copy_part(from, width, x - RLF_FILL_GAP, RLF_GAP_WIDTH, out->has[k]);
        }
    }
}

/* Steps of (dx, dy) to the first pixel with depth; RLF_FILL_GAP + 1 when none is within `reach`.
 * Looks at all of them from the last to the first: where holes end is not to be foreseen. */
RLF_KERNEL_PART void count_steps(const rlf_gap_patch *restrict patch, int32_t dx, int32_t dy,
                                 int32_t reach, uint8_t *restrict steps)
{
    const uint8_t *restrict from = &patch->has[RLF_FILL_GAP][RLF_FILL_GAP];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        uint8_t nearest = RLF_FILL_GAP + 1;
        for (int32_t d = reach; d >= 1; d--) {
            uint8_t has = from[d * (dy * RLF_GAP_WIDTH + dx) + i];
            nearest = has != 0 ? (uint8_t)d : nearest;
        }
        steps[i] = nearest;
    }
}

/* Takes a line where its gap is at most so long, and none was found before, or when it `competes`
 * a longer one. */
RLF_KERNEL_PART void offer_line(const rlf_gap_patch *restrict patch, uint8_t line, int32_t dx,
                                int32_t dy, int32_t most, bool competes, rlf_gaps *restrict best)
{
    uint8_t before[RLF_BATCH], after[RLF_BATCH];
    count_steps(patch, -dx, -dy, most - 1, before);
    count_steps(patch, dx, dy, most - 1, after);
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        uint8_t old_before = best->to_before[i], old_after = best->to_after[i];
        uint8_t span = (uint8_t)(before[i] + after[i]), least = (uint8_t)(old_before + old_after);
        uint8_t old = best->line[i];
        bool better = (old == RLF_LINE_NONE) | (competes & (span < least));
        bool taken = (span <= most) & better;
        best->line[i] = taken ? line : old;
        best->to_before[i] = taken ? before[i] : old_before;
        best->to_after[i] = taken ? after[i] : old_after;
    }
}

RLF_KERNEL void rlf_kernel_gap_patch(const rlf_gap_patch *restrict patch, rlf_gaps *restrict out)
{
    rlf_gaps best;
    memset(&best, 0, sizeof best);
    memset(best.line, RLF_LINE_NONE, sizeof best.line);
    offer_line(patch, RLF_LINE_ROW, 1, 0, RLF_FILL_GAP + 1, true, &best);
    offer_line(patch, RLF_LINE_COLUMN, 0, 1, RLF_FILL_GAP + 1, true, &best);
    offer_line(patch, RLF_LINE_DOWN, 1, 1, DIAGONAL_GAP, false, &best);
    offer_line(patch, RLF_LINE_UP, -1, 1, DIAGONAL_GAP, false, &best);
    *out = best;
}
