/* Recalls pixels that the sensor has dropped from what the frames before have seen there.
 *
 * Near depth edges a driver drops most pixels, others at random in each frame; where nothing moves,
 * what was seen there is still there. The memory is the steadied depth (steady.c). It is recalled
 * where a pixel seen now, within two pixels, continues it, and it is forgotten for good when
 * something moves about it: so nothing that has left can stay, and nothing hangs in the air. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/patch.h"

enum {
    BLOCK = RLF_HOLD_BLOCK,
    LEAST_MOVED = 2,  /* pixels of a block that make a movement: single ones may be mixed */
    LEAST_CALM = 8,   /* frames without one */
    LEAST_FRAMES = 2, /* that have seen what is recalled */
    MOST_CALM = 255
};

typedef struct hold_job {
    const rlf_reconstruct *stage;
    rlf_kernel_noise noise;
    uint8_t *change; /* plane of RLF_CHANGE_ */
    int32_t blocks_x, blocks_y;
    float *depth;
    uint8_t *reason;
} hold_job;

static void update_calm(const hold_job *job, int32_t bx, int32_t by)
{
    const rlf_grid *grid = &job->stage->grid;
    uint8_t *calm = &job->stage->steady.calm[by * job->blocks_x + bx];
    int32_t moved = 0;
    for (int32_t y = by * BLOCK; y < rlf_least((by + 1) * BLOCK, grid->height); y++) {
        const uint8_t *row = job->change + (ptrdiff_t)y * grid->width;
        for (int32_t x = bx * BLOCK; x < rlf_least((bx + 1) * BLOCK, grid->width); x++) {
            moved += row[x] == RLF_CHANGE_MOVED;
        }
    }
    *calm = (uint8_t)(moved >= LEAST_MOVED ? 0 : rlf_least(*calm + 1, MOST_CALM));
}

static void mark_blocks(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const hold_job *job = context;
    const rlf_steady *steady = &job->stage->steady;
    ptrdiff_t width = job->stage->grid.width;
    for (int32_t by = begin; by < end; by++) {
        for (int32_t y = by * BLOCK; y < rlf_least((by + 1) * BLOCK, job->stage->grid.height);
             y++) {
            rlf_kernel_change_row(job->noise, job->depth + y * width, steady->mean + y * width,
                                  steady->frames + y * width, (int32_t)width,
                                  job->change + y * width);
        }
        for (int32_t bx = 0; bx < job->blocks_x; bx++) {
            update_calm(job, bx, by);
        }
    }
}

static bool is_lost(const hold_job *job, ptrdiff_t i)
{
    bool dropped = job->reason[i] == RLF_REASON_NO_RETURN || job->reason[i] == RLF_REASON_FLYING;
    return dropped && job->stage->steady.frames[i] > 0.0f;
}

static bool is_calm(const hold_job *job, int32_t x, int32_t y)
{
    int32_t bx = x / BLOCK, by = y / BLOCK;
    int32_t x0 = bx > 0 ? bx - 1 : 0, x1 = rlf_least(bx + 1, job->blocks_x - 1);
    int32_t y0 = by > 0 ? by - 1 : 0, y1 = rlf_least(by + 1, job->blocks_y - 1);
    bool calm = true;
    for (by = y0; by <= y1; by++) {
        for (bx = x0; bx <= x1; bx++) {
            calm = calm && job->stage->steady.calm[by * job->blocks_x + bx] >= LEAST_CALM;
        }
    }
    return calm;
}

static void recall_pixel(const hold_job *job, ptrdiff_t i, bool calm, uint8_t about)
{
    const rlf_steady *steady = &job->stage->steady;
    if (!calm || (about & RLF_ABOUT_MOVED) != 0) {
        steady->frames[i] = -steady->frames[i]; /* still proves that what is seen next is new */
    } else if (about != 0 && steady->frames[i] >= LEAST_FRAMES) {
        job->depth[i] = 1.0f / steady->mean[i];
        job->reason[i] = RLF_REASON_FILLED;
    }
}

/* The lost pixels of a patch. */
static void recall_patch(const hold_job *job, int32_t x, int32_t y)
{
    const rlf_grid *grid = &job->stage->grid;
    ptrdiff_t row = (ptrdiff_t)y * grid->width;
    int32_t size = (int32_t)sizeof(float);
    rlf_patch depth;
    rlf_byte_patch change;
    float inverse[RLF_PATCH];
    uint8_t about[RLF_PATCH];
    rlf_patch_read(job->depth, grid->width, grid->height, x, y, &depth);
    rlf_byte_patch_read(job->change, grid->width, grid->height, x, y, &change);
    rlf_patch_copy(job->stage->steady.mean + row, grid->width * size, x * size, RLF_PATCH * size,
                   inverse);
    rlf_kernel_recall_patch(&depth, &change, inverse, about);
    for (int32_t k = 0; k < rlf_least(RLF_PATCH, grid->width - x); k++) {
        if (is_lost(job, row + x + k)) {
            recall_pixel(job, row + x + k, is_calm(job, x + k, y), about[k]);
        }
    }
}

static void recall_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const hold_job *job = context;
    int32_t width = job->stage->grid.width;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * width;
        const uint8_t *reason = job->reason + row; /* 0 = OK */
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, width)) < width; x++) {
            if (is_lost(job, row + x)) {
                recall_patch(job, x, y);
                x += RLF_PATCH - 1;
            }
        }
    }
}

void rlf_hold_recall(const rlf_reconstruct *stage, float *depth, uint8_t *reason)
{
    const rlf_grid *grid = &stage->grid;
    hold_job job = {.stage = stage,
                    .noise = rlf_kernel_noise_make(&stage->def.rig.noise),
                    .change = stage->work.mask[0],
                    .blocks_x = (grid->width + BLOCK - 1) / BLOCK,
                    .blocks_y = (grid->height + BLOCK - 1) / BLOCK,
                    .depth = depth,
                    .reason = reason};
    rlf_parallel_for(stage->def.pool, job.blocks_y, RLF_ROW_GRAIN / BLOCK, mark_blocks, &job);
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, recall_rows, &job);
}
