/* The background by observation: per pixel one-sided and noise-scaled (kernel/background_row.c),
 * then what the neighbourhood says: a 3x3 majority, and a decision about pixels that have depth for
 * the first time. */
#include "surface/steps.h"

#include "kernel/kernel.h"

#include <string.h>

enum {
    CHUNKS = RLF_IMAGE_SIZE_MAX / RLF_ROW_GRAIN,
    HOLE_FRAMES = 10,        /* background samples in a row that fill a hole of the model */
    HOLE_FRAMES_FRONT = 250, /* the same for what was taken as foreground */
    SHEET_CHANGES = 30,      /* replaced pixels that make a new sheet ... */
    SHEET_FRAMES = 5,        /* ... after at least this many frames */
    SHEET_URGENT = 400,      /* replaced pixels that make one at once: a thing has left */
    SHEET_FRAMES_LONG = 30,  /* after this many any change does */
    REFINED_FRAMES = 64      /* until then the means still get better */
};

typedef struct model_job {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    rlf_kernel_background params;
    uint8_t *seen;
    int32_t changed[CHUNKS]; /* per chunk, so that the sum does not depend on the workers */
} model_job;

static void model_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    model_job *job = context;
    const rlf_background *background = &job->stage->background;
    int32_t width = job->stage->grid.width;
    int32_t changed = 0;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * width;
        const rlf_kernel_model model = {background->mean + row, background->deviation + row,
                                        background->weight + row, background->beyond + row};
        changed += rlf_kernel_background_row(&job->params, job->slot->depth + row, width, &model,
                                             job->seen + row);
    }
    job->changed[begin / RLF_ROW_GRAIN] = changed;
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

static void learn_hole(rlf_background *background, int32_t i, float z, bool front)
{
    int32_t age = background->unknown_age[i] + 1;
    if (age >= (front ? HOLE_FRAMES_FRONT : HOLE_FRAMES)) {
        background->mean[i] = z;
        background->deviation[i] = 0.0f;
        background->weight[i] = 1;
        background->changed++;
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
                    learn_hole(&stage->background, i, slot->depth[i], front);
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
    stage->has_components = stage->def.foreground_segment == RLF_SEGMENT_NOISE;
    decide_unknown(stage, slot);
}

static bool is_sheet_due(const rlf_background *background)
{
    if (background->newest < 0) {
        return true;
    }
    if (background->changed >= SHEET_CHANGES) {
        return background->changed >= SHEET_URGENT || background->sheet_age >= SHEET_FRAMES;
    }
    bool refining = background->frames <= REFINED_FRAMES;
    return background->sheet_age >= SHEET_FRAMES_LONG && (background->changed > 0 || refining);
}

void rlf_background_adaptive_update(rlf_reconstruct *stage, rlf_slot *slot)
{
    rlf_background *background = &stage->background;
    const rlf_reconstruct_def *def = &stage->def;
    bool learning = background->frames < def->background_frames;
    model_job job = {.stage = stage,
                     .slot = slot,
                     .params = {rlf_kernel_noise_make(&def->rig.noise),
                                (float)def->foreground_sigmas, (float)def->foreground_min_m,
                                learning},
                     .seen = stage->work.mask[0]};
    rlf_parallel_for(def->pool, stage->grid.height, RLF_ROW_GRAIN, model_rows, &job);
    for (int32_t y = 0; y < stage->grid.height; y += RLF_ROW_GRAIN) {
        background->changed += job.changed[y / RLF_ROW_GRAIN];
    }
    background->sheet_age++;
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
        rlf_parallel_for(def->pool, stage->grid.height, RLF_ROW_GRAIN, majority_rows, &job);
        rlf_background_restore(stage, slot);
    }
    if (is_sheet_due(background)) {
        rlf_background_publish(stage);
    }
    if (!learning) {
        find_front(stage, slot);
        rlf_background_absorb(stage, slot);
    }
}
