/* How thick the foreground is.
 *
 * Every pixel lies on four chords, one in each direction (thickness.h). Each chord's conic says
 * where the back is; the short ones and those that explain their front count most. Where a body
 * behind, whose chord goes on behind the pixel, begins before the pixel's own body ends, they are
 * one solid. What is flat up to
 * noise is a thin plate. Nothing reaches into the background behind it. */
#include "surface/thickness.h"

#include "surface/steps.h"

#include <string.h>

static const float plate_m = 0.02f, thickest_m = 0.50f;
static const float body_jump_m = 0.04f; /* farther pixels are another body */
static const float farthest_w = 0.05f;  /* 1/m; keeps what cannot be from infinity */

static void prepare_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_chord_job *job = context;
    const rlf_reconstruct *stage = job->stage;
    const rlf_slot *slot = job->slot;
    bool kept = stage->def.enable_fill || stage->def.enable_smoothing;
    const float *raw = kept ? stage->work.depth[1] : slot->depth;
    for (int32_t y = job->y0 + begin; y < job->y0 + end; y++) {
        ptrdiff_t from = (ptrdiff_t)y * stage->grid.width + job->x0, to = y * job->pitch + job->x0;
        for (int32_t x = 0; x < job->width; x++) {
            ptrdiff_t i = from + x;
            bool member = slot->foreground[i] && slot->label[i] > 0;
            job->front[to + x] = member ? slot->depth[i] : 0.0f;
            job->inverse[to + x] = member && raw[i] > 0.0f ? 1.0f / raw[i] : 0.0f;
            job->label[to + x] = slot->label[i];
        }
        for (int k = 0; k < 6; k++) {
            memset(stage->work.solid[k] + to, 0, (size_t)job->width * sizeof(float));
        }
    }
}

static void cut_lines(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_chord_job *job = context;
    for (int32_t q = begin; q < end; q++) {
        rlf_line line = rlf_line_at(job, q);
        job->counts[q] =
            rlf_chords_cut(job, &line, &job->chords[(ptrdiff_t)q * RLF_CHORDS_PER_LINE]);
    }
}

static void paint_lines(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_chord_job *job = context;
    for (int32_t q = begin; q < end; q++) {
        rlf_line line = rlf_line_at(job, q);
        for (int32_t i = 0; i < job->counts[q]; i++) {
            rlf_chord_paint(job, &line, &job->chords[(ptrdiff_t)q * RLF_CHORDS_PER_LINE + i]);
        }
    }
}

/* Depth of the back at pixel i. */
static float back_of(const rlf_chord_job *job, ptrdiff_t i)
{
    const rlf_solid *own = &job->own, *behind = &job->hidden;
    float back = job->front[i];
    if (own->weight[i] > 0.0f) {
        float w = (own->middle[i] - own->half[i]) / own->weight[i];
        float seen = 1.0f / (w > farthest_w ? w : farthest_w);
        back = seen > back ? seen : back;
    }
    if (behind->weight[i] > 0.0f) {
        float middle = behind->middle[i] / behind->weight[i];
        float half = behind->half[i] / behind->weight[i];
        float w = middle - half;
        float hidden = 1.0f / (w > farthest_w ? w : farthest_w);
        bool touching = back * (middle + half) > 1.0f;
        back = touching && hidden > back ? hidden : back;
    }
    return back;
}

static void resolve_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_chord_job *job = context;
    for (int32_t y = job->y0 + begin; y < job->y0 + end; y++) {
        ptrdiff_t from = y * job->pitch + job->x0;
        float *thickness = job->stage->work.sum[1] + from;
        for (int32_t x = 0; x < job->width; x++) {
            float front = job->front[from + x];
            thickness[x] = front > 0.0f ? back_of(job, from + x) - front : 0.0f;
        }
    }
}

static bool is_plate(const rlf_chord_job *job, const rlf_region *region)
{
    double sigma = rlf_depth_noise_sigma(&job->stage->def.rig.noise, region->centroid.z);
    return region->plane_residual >= 0.0 && region->plane_residual <= 2.0 * sigma;
}

/* Chords side by side disagree a little: the mean over the pixels around is better. The block has a
 * pixel around its regions but at the image's border. */
static void smooth_row(const rlf_chord_job *job, int32_t y)
{
    ptrdiff_t pitch = job->pitch, first = y * pitch + job->x0;
    const float *raw = job->stage->work.sum[1] + first, *front = job->front + first;
    float *out = job->slot->thickness + (ptrdiff_t)y * job->stage->grid.width + job->x0;
    memcpy(out, raw, (size_t)job->width * sizeof *out);
    if (y > job->y0 && y + 1 < job->y0 + job->height) {
        const float *const depths[3] = {front - pitch, front, front + pitch};
        const float *const values[3] = {raw - pitch, raw, raw + pitch};
        rlf_kernel_body_mean_row(depths, values, job->width, body_jump_m, out);
    }
}

/* Between a plate's thickness and the room behind. */
static void limit_run(const rlf_chord_job *job, const rlf_run *run, int32_t y)
{
    const rlf_slot *slot = job->slot;
    const rlf_region *region = &slot->regions[slot->foreground_region_first + run->component - 1];
    ptrdiff_t first = (ptrdiff_t)y * job->stage->grid.width + run->x0;
    const rlf_kernel_thickness limits = {plate_m, is_plate(job, region) ? plate_m : thickest_m};
    rlf_kernel_thickness_row(&limits, slot->depth + first, job->stage->background.mean + first,
                             run->x1 - run->x0, slot->thickness + first);
}

static void write_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_chord_job *job = context;
    const rlf_runs *runs = &job->stage->work.runs;
    for (int32_t y = job->y0 + begin; y < job->y0 + end; y++) {
        smooth_row(job, y);
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            const rlf_run *run = &runs->run[r];
            if (run->component > 0 && run->x0 >= job->x0 && run->x0 < job->x0 + job->width) {
                limit_run(job, run, y);
            }
        }
    }
}

static void estimate_block(rlf_chord_job *job)
{
    static const int32_t directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    rlf_pool *pool = job->stage->def.pool;
    rlf_parallel_for(pool, job->height, RLF_ROW_GRAIN, prepare_rows, job);
    for (int d = 0; d < 4; d++) {
        job->dx = directions[d][0];
        job->dy = directions[d][1];
        int32_t count = rlf_line_count(job);
        rlf_parallel_for(pool, count, RLF_ROW_GRAIN, cut_lines, job);
        rlf_chords_pool(job, count);
        if (job->dy == 0) {
            rlf_chords_align(job, count);
        }
        rlf_parallel_for(pool, count, RLF_ROW_GRAIN, paint_lines, job);
    }
    rlf_parallel_for(pool, job->height, RLF_ROW_GRAIN, resolve_rows, job);
    rlf_parallel_for(pool, job->height, RLF_ROW_GRAIN, write_rows, job);
}

/* Rectangles of the foreground's regions with a pixel around, those that overlap as one. */
static int32_t find_blocks(const rlf_reconstruct *stage, const rlf_slot *slot, rlf_block *blocks)
{
    const rlf_grid *grid = &stage->grid;
    int32_t count = 0;
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        const rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        rlf_block b = {region->x0 > 0 ? region->x0 - 1 : 0, region->y0 > 0 ? region->y0 - 1 : 0,
                       region->x1 < grid->width ? region->x1 + 1 : grid->width,
                       region->y1 < grid->height ? region->y1 + 1 : grid->height};
        for (int32_t k = 0; k < count;) {
            rlf_block *o = &blocks[k];
            if (o->x0 >= b.x1 || b.x0 >= o->x1 || o->y0 >= b.y1 || b.y0 >= o->y1) {
                k++;
                continue;
            }
            b = (rlf_block){o->x0 < b.x0 ? o->x0 : b.x0, o->y0 < b.y0 ? o->y0 : b.y0,
                            o->x1 > b.x1 ? o->x1 : b.x1, o->y1 > b.y1 ? o->y1 : b.y1};
            *o = blocks[--count];
            k = 0; /* it has grown */
        }
        blocks[count++] = b;
    }
    return count;
}

void rlf_thickness_estimate(rlf_reconstruct *stage, rlf_slot *slot)
{
    memset(slot->thickness, 0, (size_t)stage->grid.count * sizeof *slot->thickness);
    float *const *solid = stage->work.solid;
    rlf_chord_job job = {.stage = stage,
                         .slot = slot,
                         .pitch = (ptrdiff_t)stage->grid.width + RLF_CHORD_PAD,
                         .front = stage->work.depth[0],
                         .inverse = stage->work.sum[0],
                         .label = stage->work.component,
                         .own = {solid[0], solid[1], solid[2]},
                         .hidden = {solid[3], solid[4], solid[5]},
                         .chords = stage->work.chords,
                         .counts = stage->work.size,
                         .noise = rlf_kernel_noise_make(&stage->def.rig.noise)};
    int32_t count = find_blocks(stage, slot, stage->work.blocks);
    for (int32_t i = 0; i < count; i++) {
        const rlf_block *b = &stage->work.blocks[i];
        job.x0 = b->x0;
        job.y0 = b->y0;
        job.width = b->x1 - b->x0;
        job.height = b->y1 - b->y0;
        estimate_block(&job);
    }
}
