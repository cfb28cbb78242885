/* A thing a few pixels wide that moves may be lost for some frames: drivers take a band away on
 * both sides of an edge, and the bands of its two edges meet. Then the gap shows what is behind on
 * both sides, and would be filled with that. Where something was seen that must be there now, it
 * is that, in the middle of the gap: what is seen beyond it ends it at once. */
#include "surface/past/past.h"

#include "kernel/batch.h"
#include <string.h>

enum {
    TICKS_PER_S = 100,
    LONGEST_TICKS = 30, /* without a pixel of it that is seen */
    KNOWN_TICKS = 255,  /* it is followed otherwise */
    WIDEST_PX = RLF_FILL_GAP - 2,
    EDGE_PX = 2, /* what is taken away beside an edge, on its far side */
    REACH_PX = 2 /* velocity is off by this much */
};
static const float body_jump_m = 0.04f;
static const float known_before_m = 0.03f; /* nothing seen beside it is nearer than this */
static const float step_behind = 0.05f;    /* share of the depth: a nearer end is no background */

/* Notes the pixel's depth where nothing is seen, the nearest. */
static void expect(rlf_past *past, ptrdiff_t k, float z, ptrdiff_t from, int32_t ticks)
{
    bool is_first = !rlf_past_is_ahead(past, k);
    if (ticks > LONGEST_TICKS || (!is_first && past->ahead[k] <= z)) {
        return;
    }
    past->is_ahead[k >> 3] |= (uint8_t)(1 << (k & 7));
    past->ahead[k] = z;
    past->ahead_ticks[k] = (uint8_t)ticks;
    past->ahead_from[k] = (int32_t)from;
    if (is_first) {
        past->ahead_pixel[past->ahead_count++] = (int32_t)k;
    }
}

void rlf_past_know(rlf_past *past, ptrdiff_t k, float z)
{
    if (!rlf_past_is_ahead(past, k)) {
        past->is_ahead[k >> 3] |= (uint8_t)(1 << (k & 7));
        past->ahead_pixel[past->ahead_count++] = (int32_t)k;
    }
    past->ahead[k] = z;
    past->ahead_ticks[k] = KNOWN_TICKS;
    past->ahead_from[k] = (int32_t)k;
}

/* Whether pixel i, or one of its body beside it, was seen itself: a band beside an edge was not. */
static bool was_seen(const rlf_grid *grid, const rlf_slot *before, int32_t x, int32_t y)
{
    const int32_t steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
    bool is_seen = before->reason[i] == RLF_REASON_OK;
    for (int32_t k = 0; k < 4 * EDGE_PX && !is_seen; k++) {
        int32_t u = x + steps[k % 4][0] * (1 + k / 4), v = y + steps[k % 4][1] * (1 + k / 4);
        ptrdiff_t n = (ptrdiff_t)v * grid->width + u;
        bool is_inside = u >= 0 && v >= 0 && u < grid->width && v < grid->height;
        if (is_inside && rlf_past_is_front(before, n) && before->reason[n] == RLF_REASON_OK) {
            float step = before->depth[n] - before->depth[i];
            is_seen = step < body_jump_m && step > -body_jump_m;
        }
    }
    return is_seen;
}

/* Some pixels of a row of the frame before, at most RLF_PAST_PIXELS. */
static void predict_pixels(rlf_reconstruct *stage, const rlf_kernel_moving_row *row,
                           const rlf_kernel_motion *motion, const float *depth)
{
    const rlf_grid *grid = &stage->grid;
    const rlf_slot *before = stage->previous;
    rlf_past *past = &stage->past;
    int32_t ticks = (int32_t)(motion->dt * TICKS_PER_S + 0.5f);
    float z[RLF_PAST_PIXELS];
    int32_t to[RLF_PAST_PIXELS];
    rlf_kernel_move_row(motion, row, depth, z, to);
    for (int32_t k = 0; k < row->count; k++) {
        int32_t x = row->x + k;
        ptrdiff_t i = (ptrdiff_t)row->y * grid->width + x;
        if (to[k] < 0 || !rlf_past_is_narrow(grid, before, i, WIDEST_PX)) {
            continue;
        }
        bool is_seen = was_seen(grid, before, x, row->y);
        if (is_seen || past->lost_ticks[i] > 0) {
            expect(past, to[k], z[k], i, (is_seen ? 0 : past->lost_ticks[i]) + ticks);
        }
    }
}

void rlf_past_reset(rlf_past *past, const rlf_grid *grid)
{
    past->ahead_count = 0;
    if (past->ahead != NULL) {
        memset(past->is_ahead, 0, (size_t)grid->count / 8 + 1);
        memset(past->lost_ticks, 0, (size_t)grid->count);
    }
}

void rlf_past_predict(rlf_reconstruct *stage, const rlf_slot *slot, const float *depth)
{
    const rlf_grid *grid = &stage->grid;
    const rlf_slot *before = stage->previous;
    rlf_past *past = &stage->past;
    const rlf_kernel_motion motion = rlf_past_motion(grid, rlf_past_elapsed(stage, slot));
    for (int32_t i = 0; i < past->ahead_count; i++) {
        past->is_ahead[past->ahead_pixel[i] >> 3] = 0;
    }
    past->ahead_count = 0;
    for (int32_t y = 0; y < grid->height && motion.dt > 0.0f; y++) {
        const uint8_t *front = before->foreground + (ptrdiff_t)y * grid->width;
        const rlf_span moved = before->moved[y];
        for (int32_t x = moved.x0; (x = rlf_kernel_next_mark(front, x, moved.x1)) < moved.x1;
             x += RLF_PAST_PIXELS) {
            int32_t rest = moved.x1 - x;
            rlf_kernel_moving_row row =
                rlf_past_row(grid, before, x, y, rest < RLF_PAST_PIXELS ? rest : RLF_PAST_PIXELS);
            predict_pixels(stage, &row, &motion, depth);
        }
    }
    memset(past->lost_ticks, 0, (size_t)grid->count);
}

float rlf_past_find_lost(const rlf_reconstruct *stage, ptrdiff_t i, ptrdiff_t step,
                         const int32_t to_ends[2], float nearest)
{
    static const int32_t offsets[2 * REACH_PX + 1] = {0, 1, -1, 2, -2};
    const rlf_past *past = &stage->past;
    bool is_narrow = to_ends[0] + to_ends[1] <= 2 * EDGE_PX;
    bool is_edge = to_ends[0] < EDGE_PX || to_ends[1] < EDGE_PX;
    int32_t count = is_narrow ? 1 : is_edge ? 0 : 2 * REACH_PX + 1;
    if (past->ahead_count == 0) {
        return 0.0f;
    }
    if (rlf_past_is_ahead(past, i) && past->ahead_ticks[i] == KNOWN_TICKS) {
        bool is_before = past->ahead[i] < nearest + known_before_m;
        past->lost_ticks[i] = is_before ? KNOWN_TICKS : 0;
        past->lost_from[i] = past->ahead_from[i];
        return is_before ? past->ahead[i] : 0.0f;
    }
    for (int32_t k = 0; k < count; k++) {
        if (offsets[k] >= to_ends[1] || -offsets[k] >= to_ends[0]) {
            continue;
        }
        ptrdiff_t at = i + offsets[k] * step;
        if (rlf_past_is_ahead(past, at) && past->ahead_ticks[at] != KNOWN_TICKS &&
            past->ahead[at] < (1.0f - step_behind) * nearest) {
            past->lost_ticks[i] = past->ahead_ticks[at];
            past->lost_from[i] = past->ahead_from[at];
            return past->ahead[at];
        }
    }
    return 0.0f;
}

void rlf_past_keep_velocity(const rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_past *past = &stage->past;
    int32_t width = stage->grid.width;
    for (int32_t y = 0; y < stage->grid.height && past->ahead_count > 0; y++) {
        const uint8_t *lost = past->lost_ticks + (ptrdiff_t)y * width;
        for (int32_t x = 0; (x = rlf_kernel_next_mark(lost, x, width)) < width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * width + x;
            float square = 0.0f;
            for (int c = 0; c < 3; c++) {
                square += slot->velocity[c][i] * slot->velocity[c][i];
            }
            for (int c = 0; c < 3 && !(square > 0.0f) && slot->foreground[i] != 0; c++) {
                slot->velocity[c][i] = stage->previous->velocity[c][past->lost_from[i]];
            }
        }
    }
}
