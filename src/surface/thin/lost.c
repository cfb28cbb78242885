/* A thing a few pixels wide that moves may be lost for some frames: drivers take a band away on
 * both sides of an edge, and the bands of its two edges meet. Then the gap shows what is behind on
 * both sides, and would be filled with that. Where something was seen that must be there now, it
 * is that, in the middle of the gap: what is seen beyond it ends it at once. */
#include "surface/thin/slab.h"

#include "kernel/batch.h"
#include "kernel/flow.h"

#include <string.h>

enum {
    TICKS_PER_S = 100,
    LONGEST_TICKS = 30, /* without a pixel of it that is seen */
    SLAB_TICKS = 255,   /* it is followed otherwise */
    WIDEST_PX = RLF_FILL_GAP - 2,
    EDGE_PX = 2,  /* what is taken away beside an edge, on its far side */
    REACH_PX = 2, /* velocity is off by this much */
    CHUNK = 128   /* pixels that are looked at together */
};
static const float known_before_m = 0.03f; /* nothing seen beside it is nearer than this */
static const float step_behind = 0.05f;    /* share of the depth: a nearer end is no background */

/* Pixels of the same body from k on along `step`, up to `limit`. */
static int32_t run_length(const rlf_slot *slot, ptrdiff_t k, ptrdiff_t step, int32_t limit)
{
    float z = slot->depth[k];
    for (int32_t n = 0; n < limit; n++) {
        k += step;
        float next = slot->depth[k];
        if (slot->foreground[k] == 0 || !(next > 0.0f) ||
            rlf_kernel_abs(next - z) > (float)THIN_STEP_M) {
            return n;
        }
        z = next;
    }
    return limit;
}

/* Whether the body that the pixel shows is narrow there, along its row or its column. */
static bool is_narrow(const image_grid *grid, const rlf_slot *slot, int32_t x, int32_t y)
{
    const int32_t most = WIDEST_PX, w = grid->width;
    const ptrdiff_t k = (ptrdiff_t)y * w + x;
    int32_t wide = run_length(slot, k, 1, rlf_least(most, w - 1 - x));
    wide += run_length(slot, k, -1, rlf_least(most - wide, x));
    int32_t high = wide < most ? 0 : run_length(slot, k, w, rlf_least(most, grid->height - 1 - y));
    high += wide < most ? 0 : run_length(slot, k, -(ptrdiff_t)w, rlf_least(most - high, y));
    return wide < most || high < most;
}

static void put(thin *state, ptrdiff_t k, thin_expected e)
{
    if (!(state->expected[k].depth > 0.0f)) {
        state->expected_pixel[state->expected_count++] = (int32_t)k;
    }
    state->expected[k] = e;
}

void thin_expect_slab(thin *state, ptrdiff_t k, float z)
{
    put(state, k, (thin_expected){z, (int32_t)k, SLAB_TICKS});
}

/* Some pixels of a row of the frame before, at most CHUNK. */
static void expect_pixels(const thin_in *in, thin *state, int32_t first, int32_t y, int32_t count)
{
    const image_grid *grid = in->grid;
    const rlf_slot *before = in->before;
    const ptrdiff_t at = (ptrdiff_t)y * grid->width + first;
    const rlf_kernel_motion motion = {in->dt,
                                      (float)grid->camera.fx,
                                      (float)grid->camera.fy,
                                      (float)THIN_LEAST_Z,
                                      grid->width,
                                      grid->height};
    const rlf_kernel_moving_row row = {
        before->foreground + at,
        before->depth + at,
        grid->ray_x + at,
        grid->ray_y + at,
        {before->velocity[0] + at, before->velocity[1] + at, before->velocity[2] + at},
        first,
        y,
        count};
    int32_t ticks = (int32_t)(in->dt * TICKS_PER_S + 0.5f), to[CHUNK];
    float z[CHUNK];
    rlf_kernel_move_row(&motion, &row, in->depth, z, to);
    for (int32_t k = 0; k < count; k++) {
        if (to[k] < 0 || !is_narrow(grid, before, first + k, y)) {
            continue;
        }
        const int32_t lost = state->lost_ticks[at + k];
        const thin_expected *there = &state->expected[to[k]];
        if (lost + ticks <= LONGEST_TICKS && (!(there->depth > 0.0f) || z[k] < there->depth)) {
            put(state, to[k], (thin_expected){z[k], (int32_t)(at + k), lost + ticks});
        }
    }
}

void thin_expect_moved(const thin_in *in, thin *state)
{
    const int32_t width = in->grid->width;
    for (int32_t i = 0; i < state->expected_count; i++) {
        state->expected[state->expected_pixel[i]].depth = 0.0f;
    }
    state->expected_count = 0;
    for (int32_t y = 0; y < in->grid->height && in->dt > 0.0f; y++) {
        const uint8_t *front = in->before->foreground + (ptrdiff_t)y * width;
        const rlf_span moved = in->before->moved[y];
        for (int32_t x = moved.x0; (x = rlf_kernel_next_mark(front, x, moved.x1)) < moved.x1;
             x += CHUNK) {
            expect_pixels(in, state, x, y, rlf_least(moved.x1 - x, CHUNK));
        }
    }
    memset(state->lost_ticks, 0, (size_t)in->grid->count);
}

static float take(const thin *state, ptrdiff_t i, const thin_expected *e)
{
    state->lost_ticks[i] = (uint8_t)e->ticks;
    state->lost_from[i] = e->from;
    return e->depth;
}

float thin_find_lost(const thin *state, ptrdiff_t i, ptrdiff_t step, const int32_t to_ends[2],
                     float nearest)
{
    static const int32_t offsets[2 * REACH_PX + 1] = {0, 1, -1, 2, -2};
    bool is_narrow_gap = to_ends[0] + to_ends[1] <= 2 * EDGE_PX;
    bool is_edge = to_ends[0] < EDGE_PX || to_ends[1] < EDGE_PX;
    int32_t count = is_narrow_gap ? 1 : is_edge ? 0 : 2 * REACH_PX + 1;
    if (state->expected_count == 0) {
        return 0.0f;
    }
    const thin_expected *here = &state->expected[i];
    if (here->depth > 0.0f && here->ticks == SLAB_TICKS) {
        return here->depth < nearest + known_before_m ? take(state, i, here) : 0.0f;
    }
    for (int32_t k = 0; k < count; k++) {
        if (offsets[k] >= to_ends[1] || -offsets[k] >= to_ends[0]) {
            continue;
        }
        const thin_expected *e = &state->expected[i + offsets[k] * step];
        if (e->depth > 0.0f && e->ticks != SLAB_TICKS &&
            e->depth < (1.0f - step_behind) * nearest) {
            return take(state, i, e);
        }
    }
    return 0.0f;
}

void thin_keep_velocity(const thin *state, const rlf_slot *before, const image_grid *grid,
                        rlf_slot *slot)
{
    for (int32_t y = 0; y < grid->height && state->expected_count > 0; y++) {
        const uint8_t *lost = state->lost_ticks + (ptrdiff_t)y * grid->width;
        for (int32_t x = 0; (x = rlf_kernel_next_mark(lost, x, grid->width)) < grid->width; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            bool rests = true;
            for (int c = 0; c < 3; c++) {
                rests = rests && slot->velocity[c][i] == 0.0f;
            }
            for (int c = 0; c < 3 && rests && slot->foreground[i] != 0; c++) {
                slot->velocity[c][i] = before->velocity[c][state->lost_from[i]];
            }
        }
    }
}
