/* Depth of holes, from the right side of an edge: see surface/depth/fill.c. */
#include "kernel/batch.h"

/* What a pixel at an offset counts: less the farther it is. */
static const float votes_at[RLF_WINDOW_SIDE][RLF_WINDOW_SIDE] = {{0.2f, 0.3f, 0.4f, 0.3f, 0.2f},
                                                                 {0.3f, 1.3f, 4.0f, 1.3f, 0.3f},
                                                                 {0.4f, 4.0f, 0.0f, 4.0f, 0.4f},
                                                                 {0.3f, 1.3f, 4.0f, 1.3f, 0.3f},
                                                                 {0.2f, 0.3f, 0.4f, 0.3f, 0.2f}};

/* Votes that differ by less are a tie, which is half of the least difference. */
static const float tie = 0.05f;

/* Share of the depth, from a side's end to a hole pixel. */
static const float most_change = 0.05f;

RLF_KERNEL_PART void count_votes(const rlf_windows *restrict depth, const float *restrict middle,
                                 float *restrict balance)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        balance[i] = 0.0f;
    }
    for (int32_t k = 0; k < RLF_WINDOW_SIDE; k++) {
        const float(*restrict row)[RLF_BATCH] = &depth->at[k * RLF_WINDOW_SIDE];
        for (int32_t i = 0; i < RLF_BATCH; i++) {
            float sum = balance[i];
            for (int32_t dx = 0; dx < RLF_WINDOW_SIDE; dx++) {
                float z = row[dx][i], vote = votes_at[k][dx];
                float side = z < middle[i] ? vote : -vote;
                sum += z > 0.0f ? side : 0.0f;
            }
            balance[i] = sum;
        }
    }
}

RLF_KERNEL void rlf_kernel_fill_votes(const rlf_windows *restrict depth,
                                      const rlf_gap_ends *restrict ends, float *restrict votes)
{
    float middle[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        middle[i] = rlf_gap_middle(ends->before[i], ends->after[i]);
    }
    count_votes(depth, middle, votes);
}

/* Sums over the pixels of one side, depth relative to its end. */
typedef struct side {
    float n[RLF_BATCH], x[RLF_BATCH], y[RLF_BATCH];
    float xx[RLF_BATCH], xy[RLF_BATCH], yy[RLF_BATCH];
    float z[RLF_BATCH], xz[RLF_BATCH], yz[RLF_BATCH];
} side;

RLF_KERNEL_PART void clear_side(side *restrict s)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        s->n[i] = s->x[i] = s->y[i] = s->xx[i] = s->xy[i] = s->yy[i] = 0.0f;
        s->z[i] = s->xz[i] = s->yz[i] = 0.0f;
    }
}

/* Sums over a row of the pixels from `least` to below `most`. */
RLF_KERNEL_PART void add_side_row(const float (*restrict row)[RLF_BATCH], float y,
                                  const float *restrict least, const float *restrict most,
                                  const float *restrict end, side *restrict s)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float row_n = 0.0f, row_x = 0.0f, row_z = 0.0f, row_xz = 0.0f, xx = s->xx[i];
        for (int32_t dx = -RLF_WINDOW_ABOUT; dx <= RLF_WINDOW_ABOUT; dx++) {
            float x = (float)dx, at = row[dx + RLF_WINDOW_ABOUT][i];
            bool is_inside = (at > 0.0f) & (at >= least[i]) & (at < most[i]);
            float has = is_inside ? 1.0f : 0.0f;
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

/* The side of the pixels that each hole pixel is on, and the range of their depths: a third
 * surface, as at corners, is of no side. What is in front is convex more often than not, so that
 * more of what is about its outline is behind: a tie is the nearer side's where nothing moves.
 * Where something does the range has no end, and a tie is the nearer end's. */
typedef struct choice {
    float end[RLF_BATCH], least[RLF_BATCH], most[RLF_BATCH];
    int32_t is_far[RLF_BATCH];
} choice;

RLF_KERNEL_PART void choose_sides(const rlf_gap_ends *restrict ends, const float *restrict votes,
                                  choice *restrict out)
{
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float before = ends->before[i], after = ends->after[i];
        float middle = rlf_gap_middle(before, after);
        int32_t before_is_near = before < after ? 1 : 0;
        int32_t by_steps = ends->to_before[i] <= ends->to_after[i] ? 1 : 0;
        int32_t by_votes = (votes[i] > 0.0f ? 1 : 0) ^ before_is_near ^ 1;
        int32_t of_tie = ends->most_apart[i] < 1.0f ? before_is_near : by_steps;
        int32_t first = rlf_kernel_abs(votes[i]) < tie ? of_tie : by_votes;
        int32_t is_far = first ^ before_is_near;
        float end = first != 0 ? before : after;
        float apart = ends->most_apart[i] * end, least = end - apart, most = end + apart;
        out->end[i] = end;
        out->least[i] = is_far != 0 && least < middle ? middle : least;
        out->most[i] = is_far == 0 && most > middle ? middle : most;
        out->is_far[i] = is_far;
    }
}

RLF_KERNEL void rlf_kernel_fill_batch(const rlf_windows *restrict depth,
                                      const rlf_gap_ends *restrict ends,
                                      const float *restrict votes, float *restrict out,
                                      uint8_t *restrict kind)
{
    choice chosen;
    side s;
    clear_side(&s);
    choose_sides(ends, votes, &chosen);
    for (int32_t k = 0; k < RLF_WINDOW_SIDE; k++) {
        add_side_row(&depth->at[k * RLF_WINDOW_SIDE], (float)(k - RLF_WINDOW_ABOUT), chosen.least,
                     chosen.most, chosen.end, &s);
    }
    int32_t kinds[RLF_BATCH];
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        float before = ends->before[i], after = ends->after[i];
        float to_before = ends->to_before[i], span = to_before + ends->to_after[i];
        bool is_edge = rlf_gap_is_edge(before, after, span);
        float t = to_before / span, between = 1.0f / ((1.0f - t) / before + t / after);
        float beside = continue_side(&s, i, chosen.end[i]);
        int32_t side_kind = chosen.is_far[i] != 0 ? RLF_FILL_FAR : RLF_FILL_NEAR;
        out[i] = is_edge ? beside : between;
        kinds[i] = is_edge ? side_kind : RLF_FILL_BETWEEN;
    }
    for (int32_t i = 0; i < RLF_BATCH; i++) {
        kind[i] = (uint8_t)kinds[i];
    }
}
