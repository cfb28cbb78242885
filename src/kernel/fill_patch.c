/* Depth of holes, from the right side of an edge: see surface/fill.c. */
#include "kernel/patch.h"

enum { DIAGONAL_GAP = 4 }; /* a wide hole must not be crossed from corner to corner */

/* What a pixel at an offset counts: less the farther it is. */
static const float votes_at[RLF_PATCH_HEIGHT][RLF_PATCH_HEIGHT] = {{0.2f, 0.3f, 0.4f, 0.3f, 0.2f},
                                                                   {0.3f, 1.3f, 4.0f, 1.3f, 0.3f},
                                                                   {0.4f, 4.0f, 0.0f, 4.0f, 0.4f},
                                                                   {0.3f, 1.3f, 4.0f, 1.3f, 0.3f},
                                                                   {0.2f, 0.3f, 0.4f, 0.3f, 0.2f}};

/* Share of the depth, from a side's end to a hole pixel. */
static const float most_change = 0.05f;

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
    bool inside = x >= RLF_FILL_GAP && x + RLF_PATCH + RLF_FILL_GAP <= width;
    for (int32_t k = 0; k < RLF_GAP_HEIGHT; k++) {
        int32_t row = y - RLF_FILL_GAP + k;
        const uint8_t *from = plane + (ptrdiff_t)row * width;
        if (row < 0 || row >= height) {
            memset(out->has[k], 0, sizeof out->has[k]);
        } else if (inside) {
            memcpy(out->has[k], from + x - RLF_FILL_GAP, sizeof out->has[k]);
        } else {
            rlf_patch_copy(from, width, x - RLF_FILL_GAP, RLF_GAP_WIDTH, out->has[k]);
        }
    }
}

/* ---- gaps ---- */

/* Steps of (dx, dy) to the first pixel with depth; RLF_FILL_GAP + 1 when none is within `reach`.
 * Looks at all of them from the last to the first: where holes end is not to be foreseen. */
RLF_KERNEL_PART void count_steps(const rlf_gap_patch *restrict patch, int32_t dx, int32_t dy,
                                 int32_t reach, uint8_t *restrict steps)
{
    const uint8_t *restrict from = &patch->has[RLF_FILL_GAP][RLF_FILL_GAP];
    for (int32_t i = 0; i < RLF_PATCH; i++) {
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
    uint8_t before[RLF_PATCH], after[RLF_PATCH];
    count_steps(patch, -dx, -dy, most - 1, before);
    count_steps(patch, dx, dy, most - 1, after);
    for (int32_t i = 0; i < RLF_PATCH; i++) {
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

/* ---- sides of an edge ---- */

/* Votes for the nearer side less those for the farther one. */
RLF_KERNEL_PART void count_votes(const rlf_patch *restrict depth, const float *restrict middle,
                                 float *restrict balance)
{
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        balance[i] = 0.0f;
    }
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT; k++) {
        const float *restrict row = depth->at[k];
        for (int32_t i = 0; i < RLF_PATCH; i++) {
            float sum = balance[i];
            for (int32_t dx = 0; dx < RLF_PATCH_HEIGHT; dx++) {
                float z = row[i + dx], vote = votes_at[k][dx];
                float side = z < middle[i] ? vote : -vote;
                sum += z > 0.0f ? side : 0.0f;
            }
            balance[i] = sum;
        }
    }
}

/* Sums over the pixels of one side, depth relative to its end. */
typedef struct side {
    float n[RLF_PATCH], x[RLF_PATCH], y[RLF_PATCH];
    float xx[RLF_PATCH], xy[RLF_PATCH], yy[RLF_PATCH];
    float z[RLF_PATCH], xz[RLF_PATCH], yz[RLF_PATCH];
} side;

RLF_KERNEL_PART void clear_side(side *restrict s)
{
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        s->n[i] = s->x[i] = s->y[i] = s->xx[i] = s->xy[i] = s->yy[i] = 0.0f;
        s->z[i] = s->xz[i] = s->yz[i] = 0.0f;
    }
}

/* Sums over a row of the pixels from `least` to below `most`. */
RLF_KERNEL_PART void add_side_row(const float *restrict row, float y, const float *restrict least,
                                  const float *restrict most, const float *restrict end,
                                  side *restrict s)
{
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        float row_n = 0.0f, row_x = 0.0f, row_z = 0.0f, row_xz = 0.0f, xx = s->xx[i];
        for (int32_t dx = -RLF_PATCH_ABOUT; dx <= RLF_PATCH_ABOUT; dx++) {
            float x = (float)dx, at = row[i + dx + RLF_PATCH_ABOUT];
            float has = (at > 0.0f) & (at >= least[i]) & (at < most[i]) ? 1.0f : 0.0f;
            float z = has * (at - end[i]);
            row_n += has;
            row_x += has * x;
            row_z += z;
            row_xz += z * x;
            xx += has * x * x;
        }
        s->xx[i] = xx;
        s->n[i] += row_n;
        s->x[i] += row_x;
        s->y[i] += y * row_n;
        s->xy[i] += y * row_x;
        s->yy[i] += y * y * row_n;
        s->z[i] += row_z;
        s->xz[i] += row_xz;
        s->yz[i] += y * row_z;
    }
}

/* The side's plane at the pixel itself, above its end. The ridge keeps it level across a direction
 * in which the side has hardly an extent. */
RLF_KERNEL_PART float continue_side(const side *restrict s, int32_t i, float end)
{
    const float ridge = 0.5f;
    float n = s->n[i], inv = n > 0.0f ? 1.0f / (n > 0.0f ? n : 1.0f) : 0.0f;
    float mx = s->x[i] * inv, my = s->y[i] * inv, mz = s->z[i] * inv;
    float xx = s->xx[i] - s->x[i] * mx + ridge, yy = s->yy[i] - s->y[i] * my + ridge;
    float xy = s->xy[i] - s->x[i] * my;
    float xz = s->xz[i] - s->x[i] * mz, yz = s->yz[i] - s->y[i] * mz;
    float inv_det = 1.0f / (xx * yy - xy * xy);
    float b = (xz * yy - yz * xy) * inv_det, c = (yz * xx - xz * xy) * inv_det;
    float z = mz - b * mx - c * my;
    float limit = most_change * end;
    z = z > limit ? limit : z;
    return end + (z < -limit ? -limit : z);
}

/* The side of the pixels that each hole pixel is on, and the range of their depths. */
typedef struct choice {
    float end[RLF_PATCH], least[RLF_PATCH], most[RLF_PATCH];
    int32_t is_far[RLF_PATCH];
} choice;

RLF_KERNEL_PART void choose_sides(const rlf_patch *restrict depth, const rlf_gaps *restrict gaps,
                                  const rlf_gap_ends *restrict ends, choice *restrict out)
{
    float middle[RLF_PATCH], balance[RLF_PATCH];
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        middle[i] = 2.0f / (1.0f / ends->before[i] + 1.0f / ends->after[i]);
    }
    count_votes(depth, middle, balance);
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        int32_t to_before = gaps->to_before[i], to_after = gaps->to_after[i];
        float before = ends->before[i], after = ends->after[i];
        int32_t before_is_near = before < after ? 1 : 0;
        int32_t tie = rlf_kernel_abs(balance[i]) < 0.05f; /* half of the least votes' difference */
        int32_t by_steps = to_before <= to_after ? 1 : 0;
        int32_t by_votes = (balance[i] > 0.0f ? 1 : 0) ^ before_is_near ^ 1;
        int32_t first = tie != 0 ? by_steps : by_votes;
        int32_t is_far = first ^ before_is_near;
        out->end[i] = first != 0 ? before : after;
        out->least[i] = is_far != 0 ? middle[i] : 0.0f;
        out->most[i] = is_far != 0 ? RLF_KERNEL_NOTHING : middle[i];
        out->is_far[i] = is_far;
    }
}

RLF_KERNEL void rlf_kernel_fill_patch(const rlf_patch *restrict depth,
                                      const rlf_gaps *restrict gaps,
                                      const rlf_gap_ends *restrict ends, float *restrict out,
                                      uint8_t *restrict kind)
{
    choice chosen;
    side s;
    clear_side(&s);
    choose_sides(depth, gaps, ends, &chosen);
    for (int32_t k = 0; k < RLF_PATCH_HEIGHT; k++) {
        add_side_row(depth->at[k], (float)(k - RLF_PATCH_ABOUT), chosen.least, chosen.most,
                     chosen.end, &s);
    }
    int32_t kinds[RLF_PATCH];
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        float before = ends->before[i], after = ends->after[i];
        float to_before = (float)gaps->to_before[i], span = to_before + (float)gaps->to_after[i];
        float nearest = before < after ? before : after;
        bool is_edge = rlf_kernel_abs(before - after) > (0.01f * span + 0.01f) * nearest;
        float t = to_before / span, between = 1.0f / ((1.0f - t) / before + t / after);
        float beside = continue_side(&s, i, chosen.end[i]);
        int32_t side_kind = chosen.is_far[i] != 0 ? RLF_FILL_FAR : RLF_FILL_NEAR;
        out[i] = is_edge ? beside : between;
        kinds[i] = is_edge ? side_kind : RLF_FILL_BETWEEN;
    }
    for (int32_t i = 0; i < RLF_PATCH; i++) {
        kind[i] = (uint8_t)kinds[i];
    }
}
