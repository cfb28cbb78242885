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
        const float *depth[3];
        for (int32_t k = 0; k < 3; k++) {
            int32_t at = y - 1 + k;
            bool inside = at >= 0 && at < grid->height;
            ptrdiff_t row = (ptrdiff_t)(inside ? at : y) * grid->width;
            rows[k] = job->seen + row;
            depth[k] = inside ? job->slot->depth + row : job->stage->work.zeros;
        }
        rlf_kernel_majority_row(rows, depth, grid->width,
                                job->slot->foreground + (ptrdiff_t)y * grid->width);
    }
}

/* vote[0][c]: pixels of component c that are in front of a known background. */
static void count_seeds(const rlf_reconstruct *stage, const uint8_t *mask, int32_t components)
{
    int32_t *seeds = stage->work.vote[0];
    memset(seeds, 0, (size_t)(components + 1) * sizeof *seeds);
    for (int32_t i = 0; i < stage->grid.count; i++) {
        if (mask[i] == RLF_SEEN_FOREGROUND) {
            seeds[stage->work.component[i]]++;
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
    uint8_t *mask = slot->foreground;
    int32_t count = stage->grid.count;
    if (memchr(mask, RLF_SEEN_UNKNOWN, (size_t)count) == NULL) {
        return;
    }
    rlf_segment_links(stage, RLF_SEGMENT_NOISE, slot->depth, mask);
    int32_t components = rlf_components_find(stage);
    count_seeds(stage, mask, components);
    for (int32_t i = 0; i < count; i++) {
        if (mask[i] != RLF_SEEN_UNKNOWN) {
            continue;
        }
        int32_t c = stage->work.component[i];
        int32_t size = stage->work.size[c];
        bool front = 10 * stage->work.vote[0][c] >= size || size >= stage->def.min_region_points;
        mask[i] = front;
        learn_hole(&stage->background, i, slot->depth[i], front);
    }
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
    if (learning && background->frames < def->background_frames) {
        background->state = RLF_BACKGROUND_LEARNING;
        return;
    }
    background->state = RLF_BACKGROUND_READY;
    if (!learning) {
        rlf_parallel_for(def->pool, stage->grid.height, RLF_ROW_GRAIN, majority_rows, &job);
        decide_unknown(stage, slot);
        rlf_background_absorb(stage, slot);
    }
    if (is_sheet_due(background)) {
        rlf_background_publish(stage);
    }
}
