/* The background by observation: per pixel one-sided and noise-scaled (kernel/background_row.c),
 * then what the neighbourhood says: foreground must be a 3x3 majority, and pixels that have depth
 * for the first time are decided about.
 *
 * Furniture that was moved: what stands nearer than the background and still for long enough
 * becomes background. What it hides is kept beneath it, and comes back at once when it is seen
 * again. */
#include "surface/motion/keyframe.h"
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum { LONGEST_STEP_MS = 200 };

typedef struct model_job {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    rlf_kernel_background params;
    uint8_t *seen;
    int32_t tile_columns;
} model_job;

static void model_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    model_job *job = context;
    const rlf_background *background = &job->stage->background;
    int32_t width = job->stage->grid.width;
    for (int32_t y = begin; y < end; y++) {
        for (int32_t x = 0; x < width; x += BACKGROUND_TILE) {
            ptrdiff_t at = (ptrdiff_t)y * width + x;
            int32_t count = x + BACKGROUND_TILE < width ? BACKGROUND_TILE : width - x;
            const rlf_kernel_model model = {background->mean + at, background->deviation + at,
                                            background->weight + at, background->beyond + at};
            int32_t changed = rlf_kernel_background_row(&job->params, job->slot->depth + at, count,
                                                        &model, job->seen + at);
            background->row_changes[y * job->tile_columns + x / BACKGROUND_TILE] = changed;
        }
    }
}

/* Row by row, so that the sums do not depend on the workers. */
static void count_changes(rlf_reconstruct *stage, int32_t tile_columns)
{
    for (int32_t y = 0; y < stage->grid.height; y++) {
        for (int32_t k = 0; k < tile_columns; k++) {
            int32_t changed = stage->background.row_changes[y * tile_columns + k];
            if (changed > 0) {
                background_image_changed(&stage->background, &stage->grid, k * BACKGROUND_TILE, y,
                                         changed);
            }
        }
    }
}

static void majority_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const model_job *job = context;
    const image_grid *grid = &job->stage->grid;
    for (int32_t y = begin; y < end; y++) {
        const uint8_t *rows[3];
        for (int32_t k = 0; k < 3; k++) {
            int32_t at = y - 1 + k;
            bool inside = at >= 0 && at < grid->height;
            rows[k] = inside ? job->seen + (ptrdiff_t)at * grid->width : job->stage->work.missing;
        }
        uint8_t *front = job->slot->foreground + (ptrdiff_t)y * grid->width;
        rlf_kernel_majority_row(rows, grid->width, front);
        job->stage->work.front[y] = rlf_background_span(front, grid->width);
    }
}

void background_majority(rlf_reconstruct *stage, const rlf_slot *slot, uint8_t *seen)
{
    model_job job = {.stage = stage, .slot = slot, .seen = seen};
    rlf_parallel_for(stage->def.pool, stage->grid.height, RLF_ROW_GRAIN, majority_rows, &job);
}

/* ---- what stands still ---- */

static int32_t step_ms(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    int64_t ms = rlf_stage_elapsed_ns(stage, slot) / 1000000;
    return ms > LONGEST_STEP_MS ? LONGEST_STEP_MS : (int32_t)ms;
}

static void replace(rlf_reconstruct *stage, int32_t i, float z)
{
    background_put(stage, i, z, RLF_STILL_WEIGHT);
    stage->background.still_ms[i] = 0;
    if (stage->background.depart.left != NULL) {
        stage->background.depart.left[i] = 0;
    }
}

static rlf_kernel_still still_of(const rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_reconstruct_def *def = &stage->def;
    return (rlf_kernel_still){.noise = def->rig.noise,
                              .sigmas = def->foreground_sigmas,
                              .least = (float)def->foreground_min_m,
                              .limit_ms = (int32_t)(1000.0 * def->absorb_after_s),
                              .passed_ms = step_ms(stage, slot)};
}

static void absorb_pixel(rlf_reconstruct *stage, int32_t i)
{
    rlf_background *background = &stage->background;
    float beneath = background->beneath[i];
    bool has_left = background->depart.left != NULL && background->depart.left[i];
    background->beneath[i] = beneath > 0.0f || has_left ? beneath : background->mean[i];
    replace(stage, i, background->still[i]);
}

/* Where pixels that stand still are left in row y, of those that are foreground or were. */
static rlf_span find_left(const rlf_reconstruct *stage, int32_t y, rlf_span span)
{
    const uint16_t *still_ms = stage->background.still_ms + (ptrdiff_t)y * stage->grid.width;
    while (span.x0 < span.x1 && still_ms[span.x0] == 0) {
        span.x0++;
    }
    while (span.x1 > span.x0 && still_ms[span.x1 - 1] == 0) {
        span.x1--;
    }
    return span;
}

static void absorb_row(rlf_reconstruct *stage, const rlf_slot *slot, const rlf_kernel_still *p,
                       int32_t y, rlf_span span)
{
    rlf_background *background = &stage->background;
    for (int32_t x = span.x0; x < span.x1; x += RLF_PART) {
        uint8_t is_due[RLF_PART];
        int32_t i = y * stage->grid.width + x, count = rlf_least(RLF_PART, span.x1 - x);
        rlf_kernel_still_row(p, slot->foreground + i, slot->depth + i, count, background->still + i,
                             background->still_ms + i, is_due);
        for (int32_t k = 0; (k = rlf_kernel_next_mark(is_due, k, count)) < count; k++) {
            absorb_pixel(stage, i + k);
        }
    }
}

static void absorb(rlf_reconstruct *stage, const rlf_slot *slot)
{
    if (!(stage->def.absorb_after_s > 0.0)) {
        return;
    }
    const rlf_kernel_still still = still_of(stage, slot);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        rlf_span *left = &stage->background.standing[y];
        rlf_span span = rlf_span_unite(*left, stage->work.front[y]);
        absorb_row(stage, slot, &still, y, span);
        *left = find_left(stage, y, span);
    }
}

/* What an absorbed thing hid, where it is seen again. */
static void restore(rlf_reconstruct *stage, const rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    for (int32_t y = 0; y < stage->grid.height; y++) {
        const rlf_span span = stage->work.front[y];
        for (int32_t i = y * stage->grid.width + span.x0; i < y * stage->grid.width + span.x1;
             i++) {
            float z = slot->depth[i], beneath = background->beneath[i];
            if (slot->foreground[i] == RLF_SEEN_PAST && beneath > 0.0f &&
                rlf_kernel_abs(z - beneath) <= rlf_background_gate(&stage->def, z)) {
                replace(stage, i, beneath);
                background->beneath[i] = 0.0f;
                slot->foreground[i] = RLF_SEEN_BACKGROUND;
            }
        }
    }
}

/* ---- a frame ---- */

/* The image of the background is made by now: it needs the same memory. */
void background_find_front(rlf_reconstruct *stage, const rlf_slot *slot)
{
    const rlf_span *spans = stage->work.front;
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, slot->depth, slot->foreground, spans);
    stage->component_count = rlf_components_find(stage, spans);
    stage->has_components = stage->def.foreground_segment == RLF_SEGMENT_NOISE;
    rlf_background_decide_unknown(stage, slot);
}

/* Keeps the newest image: surfaces may still refer to it. */
static void start_anew(rlf_reconstruct *stage)
{
    int32_t newest = stage->background.newest;
    rlf_background_reset(&stage->background, &stage->grid);
    keyframes_reset(&stage->velocity);
    stage->background.newest = newest;
    stage->background.is_stale = newest >= 0;
}

void rlf_background_adaptive_update(rlf_reconstruct *stage, const float *kept, rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    const rlf_reconstruct_def *def = &stage->def;
    bool knows = background->state == RLF_BACKGROUND_READY;
    if (stage->ego.moves || (knows && rlf_background_is_cut(stage, slot->depth))) {
        start_anew(stage);
    }
    background->frames = stage->sight.shows_more ? 0 : background->frames;
    bool learning = background->frames < def->background_frames;
    model_job job = {.stage = stage,
                     .slot = slot,
                     .params = {rlf_kernel_noise_make(&def->rig.noise),
                                (float)def->foreground_sigmas, (float)def->foreground_min_m,
                                learning},
                     .seen = stage->background.seen,
                     .tile_columns = (stage->grid.width + BACKGROUND_TILE - 1) / BACKGROUND_TILE};
    rlf_parallel_for(def->pool, stage->grid.height, RLF_ROW_GRAIN, model_rows, &job);
    count_changes(stage, job.tile_columns);
    if (background->frames < INT32_MAX) {
        background->frames++;
    }
    if (learning) {
        background_clear_front(stage, slot);
    }
    if (learning && background->frames < def->background_frames) {
        rlf_background_cover(stage, kept, slot, true);
        background->state = RLF_BACKGROUND_LEARNING;
        return;
    }
    background->state = RLF_BACKGROUND_READY;
    if (!learning) {
        rlf_depart_follow(stage, slot, job.seen);
        background_majority(stage, slot, job.seen);
        restore(stage, slot);
        rlf_depart_find(stage, slot);
    }
    background_image_advance(stage, slot);
    if (!learning) {
        rlf_background_reveal(stage, slot);
    }
    rlf_background_cover(stage, kept, slot, learning);
    if (!learning) {
        background_find_front(stage, slot);
        absorb(stage, slot);
    }
}
