/* The background by observation: per pixel one-sided and noise-scaled (kernel/background_row.c),
 * then what the neighbourhood says: foreground must be a 3x3 majority, and pixels that have depth
 * for the first time are decided about. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

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
    const rlf_grid *grid = &job->stage->grid;
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

/* The image of the background is made by now: it needs the same memory. */
static void find_front(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_span *spans = stage->work.front;
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, slot->depth, slot->foreground, spans);
    stage->component_count = rlf_components_find(stage, spans);
    stage->has_components = stage->def.foreground_segment == RLF_SEGMENT_NOISE && !stage->has_color;
    rlf_background_decide_unknown(stage, slot);
}

/* Keeps the newest image: surfaces may still refer to it. */
static void start_anew(rlf_reconstruct *stage)
{
    int32_t newest = stage->background.newest;
    rlf_background_reset(&stage->background, &stage->grid);
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
        memset(slot->foreground, 0, (size_t)stage->grid.count);
        memset(stage->work.front, 0, (size_t)stage->grid.height * sizeof *stage->work.front);
    }
    if (learning && background->frames < def->background_frames) {
        rlf_background_cover(stage, kept, slot, true);
        background->state = RLF_BACKGROUND_LEARNING;
        return;
    }
    background->state = RLF_BACKGROUND_READY;
    if (!learning) {
        rlf_depart_follow(stage, slot, job.seen);
        rlf_parallel_for(def->pool, stage->grid.height, RLF_ROW_GRAIN, majority_rows, &job);
        rlf_background_restore(stage, slot);
        rlf_depart_find(stage, slot);
    }
    background_image_advance(stage, slot);
    if (!learning) {
        rlf_background_reveal(stage, slot);
    }
    rlf_background_cover(stage, kept, slot, learning);
    if (!learning) {
        find_front(stage, slot);
        rlf_background_absorb(stage, slot);
    }
}
