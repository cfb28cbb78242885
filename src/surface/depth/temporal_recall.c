/* Recalls pixels that the sensor has dropped from what the frames before have seen there.
 *
 * Near depth edges a driver drops most pixels, others at random in each frame; where nothing moves,
 * what was seen there is still there. The memory is the mean over time (temporal_mean.c). It is
 * recalled where a pixel seen now, within two pixels, continues it, and it is forgotten for good
 * when something moves about it: so nothing that has left can stay, and nothing hangs in the air. A
 * pixel that was taken for a mixed one for want of neighbours, in a slit between two things, is
 * believed where the memory has it at the same depth. */
#include "surface/steps.h"
#include "surface/thin/thin.h"

#include "kernel/batch.h"

#include <math.h>
#include <string.h>

enum {
    BLOCK = RLF_TEMPORAL_BLOCK,
    LEAST_MOVED = 2,  /* pixels of a block that make a movement: single ones may be mixed */
    LEAST_FRAMES = 2, /* that have seen what is recalled */
    MOST_CALM = 255
};

static const float MOST_SIGMAS = 3.0f; /* from the memory to what confirms it */

typedef struct recall_job {
    const rlf_reconstruct *stage;
    rlf_kernel_noise noise;
    uint8_t *change; /* plane of RLF_CHANGE_ */
    int32_t blocks_x, blocks_y;
    const float *raw; /* as it came */
    float *depth;
    uint8_t *reason;
} recall_job;

/* The pixels of a block that have moved. */
static int32_t count_moved(const recall_job *job, int32_t bx, int32_t by)
{
    const image_grid *grid = &job->stage->grid;
    const int32_t x0 = bx * BLOCK, x1 = rlf_least(x0 + BLOCK, grid->width);
    int32_t moved = 0;
    for (int32_t y = by * BLOCK; y < rlf_least((by + 1) * BLOCK, grid->height); y++) {
        const uint8_t *row = job->change + (ptrdiff_t)y * grid->width;
        for (int32_t x = x0; x < x1; x++) {
            moved += row[x] == RLF_CHANGE_MOVED;
        }
    }
    return moved;
}

static void update_calm(const recall_job *job, int32_t bx, int32_t by)
{
    uint8_t *calm = &job->stage->temporal.calm[by * job->blocks_x + bx];
    int32_t moved = count_moved(job, bx, by);
    *calm = (uint8_t)(moved >= LEAST_MOVED ? 0 : rlf_least(*calm + 1, MOST_CALM));
}

static void mark_blocks(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const recall_job *job = context;
    const temporal *state = &job->stage->temporal;
    ptrdiff_t width = job->stage->grid.width;
    for (int32_t by = begin; by < end; by++) {
        for (int32_t y = by * BLOCK; y < rlf_least((by + 1) * BLOCK, job->stage->grid.height);
             y++) {
            rlf_kernel_change_row(job->noise, job->depth + y * width, state->mean + y * width,
                                  state->frames + y * width, (int32_t)width,
                                  job->change + y * width);
        }
        for (int32_t bx = 0; bx < job->blocks_x; bx++) {
            update_calm(job, bx, by);
        }
    }
}

static bool is_lost(const recall_job *job, ptrdiff_t i)
{
    bool dropped = job->reason[i] == RLF_REASON_NO_RETURN || job->reason[i] == RLF_REASON_FLYING;
    return dropped && job->stage->temporal.frames[i] > 0.0f;
}

/* Marks the blocks about those that are not calm, and these. */
static void mark_restless(const recall_job *job)
{
    const temporal *state = &job->stage->temporal;
    memset(state->restless, 0, (size_t)job->blocks_x * (size_t)job->blocks_y);
    for (int32_t by = 0; by < job->blocks_y; by++) {
        int32_t y0 = by > 0 ? by - 1 : 0, y1 = rlf_least(by + 1, job->blocks_y - 1);
        for (int32_t bx = 0; bx < job->blocks_x; bx++) {
            if (state->calm[by * job->blocks_x + bx] >= RLF_TEMPORAL_CALM) {
                continue;
            }
            int32_t x0 = bx > 0 ? bx - 1 : 0, x1 = rlf_least(bx + 1, job->blocks_x - 1);
            for (int32_t y = y0; y <= y1; y++) {
                memset(state->restless + y * job->blocks_x + x0, 1, (size_t)(x1 - x0 + 1));
            }
        }
    }
}

static bool is_calm(const rlf_reconstruct *stage, int32_t x, int32_t y)
{
    int32_t blocks_x = (stage->grid.width + BLOCK - 1) / BLOCK;
    return stage->temporal.restless[y / BLOCK * blocks_x + x / BLOCK] == 0;
}

bool temporal_may_move(const rlf_reconstruct *stage, int32_t x, int32_t y)
{
    bool unknown = stage->temporal.calm == NULL;
    return unknown || (stage->temporal.age >= RLF_TEMPORAL_CALM && !is_calm(stage, x, y));
}

rlf_span temporal_next_moving(const rlf_reconstruct *stage, int32_t x, int32_t y)
{
    int32_t width = stage->grid.width, blocks_x = (width + BLOCK - 1) / BLOCK;
    if (stage->temporal.calm == NULL || stage->temporal.age < RLF_TEMPORAL_CALM) {
        return (rlf_span){stage->temporal.calm == NULL ? x : width, width};
    }
    const uint8_t *restless = stage->temporal.restless + y / BLOCK * blocks_x;
    int32_t first = rlf_kernel_next_mark(restless, (x + BLOCK - 1) / BLOCK, blocks_x), end = first;
    while (end < blocks_x && restless[end] != 0) {
        end++;
    }
    return (rlf_span){rlf_least(first * BLOCK, width), rlf_least(end * BLOCK, width)};
}

/* Lost pixels about which nothing moves, that wait until there are enough of them for a kernel. */
typedef struct recall_queue {
    int32_t count;
    ptrdiff_t pixel[RLF_BATCH];
    float inverse[RLF_BATCH];
    rlf_windows seen;
} recall_queue;

/* What is seen next is new. */
static void forget(const recall_job *job, ptrdiff_t i)
{
    job->stage->temporal.frames[i] = -job->stage->temporal.frames[i];
}

static void recall_batch(const recall_job *job, recall_queue *q)
{
    uint8_t about[RLF_BATCH];
    rlf_kernel_recall_batch(&q->seen, q->inverse, about);
    for (int32_t k = 0; k < q->count; k++) {
        ptrdiff_t i = q->pixel[k];
        if ((about[k] & RLF_ABOUT_MOVED) != 0) {
            forget(job, i);
        } else if (about[k] != 0 && job->stage->temporal.frames[i] >= LEAST_FRAMES) {
            job->depth[i] = 1.0f / q->inverse[k];
            job->reason[i] = RLF_REASON_FILLED;
        }
    }
    q->count = 0;
}

/* Depth about a pixel as it was seen in this frame, negative where that moved. What was not seen is
 * not read: another worker may be recalling it. */
static void read_seen(const recall_job *job, int32_t x, int32_t y, int32_t lane,
                      rlf_windows *restrict out)
{
    enum { SIDE = RLF_WINDOW_SIDE };
    static const float sign[3] = {
        [RLF_CHANGE_UNSEEN] = 0.0f, [RLF_CHANGE_STILL] = 1.0f, [RLF_CHANGE_MOVED] = -1.0f};
    const image_grid *grid = &job->stage->grid;
    ptrdiff_t middle = (ptrdiff_t)y * grid->width + x;
    const float *depth = job->depth + middle;
    const uint8_t *change = job->change + middle;
    rlf_window_places p = rlf_window_places_make(grid->width, grid->height, x, y);
    for (int32_t r = 0; r < SIDE; r++) {
        for (int32_t c = 0; c < SIDE; c++) {
            ptrdiff_t i = p.row[r] + p.column[c];
            float inside = p.row_inside[r] * p.column_inside[c];
            ptrdiff_t from = change[i] != RLF_CHANGE_UNSEEN ? i : 0;
            out->at[r * SIDE + c][lane] = inside * sign[change[i]] * depth[from];
        }
    }
}

/* How much more noise the face at pixel i has than one that is seen squarely. */
static float slant_at(const rlf_reconstruct *stage, ptrdiff_t i)
{
    if (stage->previous == NULL) {
        return 1.0f;
    }
    float x = stage->grid.ray_x[i], y = stage->grid.ray_y[i];
    float *const *n = stage->previous->normal;
    float facing = -(n[0][i] * x + n[1][i] * y + n[2][i]), length = sqrtf(x * x + y * y + 1.0f);
    return rlf_kernel_slant(facing > 0.0f ? facing : length, length);
}

/* What was taken for a mixed pixel is where it was before. */
static bool is_confirmed(const recall_job *job, ptrdiff_t i)
{
    float z = job->reason[i] == RLF_REASON_FLYING ? job->raw[i] : 0.0f;
    if (!(z > 0.0f)) {
        return false;
    }
    float off = rlf_kernel_abs(z * job->stage->temporal.mean[i] - 1.0f); /* share of the depth */
    float sigma = rlf_kernel_sigma(job->noise, z) * slant_at(job->stage, i);
    return off * z < MOST_SIGMAS * sigma;
}

static void recall_pixel(const recall_job *job, int32_t x, int32_t y, recall_queue *q)
{
    ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
    if (thin_is_expected(&job->stage->thin, i) || !is_calm(job->stage, x, y)) {
        forget(job, i);
        return;
    }
    if (is_confirmed(job, i)) {
        job->depth[i] = job->raw[i];
        job->reason[i] = RLF_REASON_OK;
        return;
    }
    int32_t lane = q->count++;
    q->pixel[lane] = i;
    q->inverse[lane] = job->stage->temporal.mean[i];
    read_seen(job, x, y, lane, &q->seen);
    if (q->count == RLF_BATCH) {
        recall_batch(job, q);
    }
}

static void recall_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const recall_job *job = context;
    int32_t width = job->stage->grid.width;
    recall_queue queue = {0};
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * width;
        const uint8_t *reason = job->reason + row; /* 0 = OK */
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, width)) < width; x++) {
            if (is_lost(job, row + x)) {
                recall_pixel(job, x, y, &queue);
            }
        }
    }
    recall_batch(job, &queue);
}

void temporal_recall(const rlf_reconstruct *stage, const float *raw, float *depth, uint8_t *reason)
{
    const image_grid *grid = &stage->grid;
    recall_job job = {.stage = stage,
                      .noise = rlf_kernel_noise_make(&stage->def.rig.noise),
                      .change = stage->temporal.change,
                      .blocks_x = (grid->width + BLOCK - 1) / BLOCK,
                      .blocks_y = (grid->height + BLOCK - 1) / BLOCK,
                      .raw = raw,
                      .depth = depth,
                      .reason = reason};
    rlf_parallel_for(stage->def.pool, job.blocks_y, RLF_ROW_GRAIN / BLOCK, mark_blocks, &job);
    mark_restless(&job);
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, recall_rows, &job);
}
