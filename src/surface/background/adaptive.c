/* The background by observation: per pixel one-sided and noise-scaled (kernel/background_row.c),
 * then what the neighbourhood says: foreground must be a 3x3 majority, and pixels that have depth
 * for the first time are decided about. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum {
    HOLE_FRAMES = 10,        /* background samples in a row that fill a hole of the model */
    HOLE_FRAMES_FRONT = 250, /* the same for what was taken as foreground */
};

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
        for (int32_t x = 0; x < width; x += RLF_SHEET_TILE) {
            ptrdiff_t at = (ptrdiff_t)y * width + x;
            int32_t count = x + RLF_SHEET_TILE < width ? RLF_SHEET_TILE : width - x;
            const rlf_kernel_model model = {background->mean + at, background->deviation + at,
                                            background->weight + at, background->beyond + at};
            int32_t changed = rlf_kernel_background_row(&job->params, job->slot->depth + at, count,
                                                        &model, job->seen + at);
            background->row_changes[y * job->tile_columns + x / RLF_SHEET_TILE] = changed;
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
                rlf_sheet_changed(&stage->background, &stage->grid, k * RLF_SHEET_TILE, y, changed);
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

/* vote[0][c]: pixels of component c that are in front of a known background. */
static void count_seeds(const rlf_reconstruct *stage, const uint8_t *mask, int32_t components)
{
    const rlf_runs *runs = &stage->work.runs;
    int32_t *seeds = stage->work.vote[0];
    memset(seeds, 0, (size_t)(components + 1) * sizeof *seeds);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        const uint8_t *row = mask + (ptrdiff_t)y * stage->grid.width;
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            for (int32_t x = run->x0; x < run->x1; x++) {
                seeds[run->component] += row[x] == RLF_SEEN_FOREGROUND ? 1 : 0;
            }
        }
    }
}

static void learn_hole(rlf_reconstruct *stage, int32_t i, float z, bool front)
{
    rlf_background *background = &stage->background;
    int32_t age = background->unknown_age[i] + 1;
    if (age >= (front ? HOLE_FRAMES_FRONT : HOLE_FRAMES)) {
        background->mean[i] = z;
        background->deviation[i] = 0.0f;
        background->weight[i] = 1;
        rlf_sheet_changed(background, &stage->grid, i % stage->grid.width, i / stage->grid.width,
                          1);
        age = 0;
    }
    background->unknown_age[i] = (uint8_t)age;
}

/* Depth where the background has none: foreground when it hangs together with foreground or is
 * large, otherwise a hole of the model that is filled in time. */
static void decide_unknown(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_work *work = &stage->work;
    count_seeds(stage, slot->foreground, stage->component_count);
    for (int32_t y = 0; y < stage->grid.height; y++) {
        int32_t row = y * stage->grid.width;
        for (int32_t r = work->runs.first[y]; r < work->runs.first[y + 1]; r++) {
            rlf_run *run = &work->runs.run[r];
            int32_t size = work->size[run->component];
            bool front =
                10 * work->vote[0][run->component] >= size || size >= stage->def.min_region_points;
            for (int32_t i = row + run->x0; i < row + run->x1; i++) {
                if (slot->foreground[i] == RLF_SEEN_UNKNOWN) {
                    learn_hole(stage, i, slot->depth[i], front);
                }
                slot->foreground[i] = front;
            }
            run->component = front ? run->component : 0;
        }
    }
}

/* The sheet of the background is made by now: it needs the same memory. */
static void find_front(rlf_reconstruct *stage, rlf_slot *slot)
{
    const rlf_span *spans = stage->work.front;
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, slot->depth, slot->foreground, spans);
    stage->component_count = rlf_components_find(stage, spans);
    stage->has_components = stage->def.foreground_segment == RLF_SEGMENT_NOISE && !stage->has_color;
    decide_unknown(stage, slot);
}

/* Keeps the newest sheet: surfaces may still refer to it. */
static void start_anew(rlf_reconstruct *stage)
{
    int32_t newest = stage->background.newest;
    rlf_background_reset(&stage->background, &stage->grid);
    stage->background.newest = newest;
    stage->background.is_stale = newest >= 0;
}

void rlf_background_adaptive_update(rlf_reconstruct *stage, rlf_slot *slot)
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
                     .seen = stage->work.mask[0],
                     .tile_columns = (stage->grid.width + RLF_SHEET_TILE - 1) / RLF_SHEET_TILE};
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
    rlf_sheet_advance(stage, slot);
    if (!learning) {
        find_front(stage, slot);
        rlf_background_absorb(stage, slot);
    }
}
