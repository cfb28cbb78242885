/* How thick the foreground is.
 *
 * Every knot (thickness.h) lies on four chords, one in each direction. Each chord's
 * conic says where the back is; the short ones and those that explain their front count most. Where
 * a body behind, whose chord goes on behind the knot, begins before the knot's own body ends,
 * they are one solid. What is flat up to noise is a thin plate. Nothing reaches into the background
 * behind it. */
#include "surface/thickness/thickness.h"

#include "surface/steps.h"

#include <string.h>

static const float farthest_w = 0.05f; /* 1/m; keeps what cannot be from infinity */

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

/* Depth of the back at knot i. */
static float back_of(const rlf_chord_job *job, ptrdiff_t i)
{
    const rlf_solid *own = &job->own, *behind = &job->hidden;
    float back = job->knot[i];
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
    int32_t x0 = job->x0 / job->step, x1 = (job->x0 + job->width + job->step - 1) / job->step;
    int32_t y0 = job->y0 / job->step + begin, y1 = job->y0 / job->step + end;
    for (int32_t y = y0; y < y1; y++) {
        ptrdiff_t row = y * job->knot_pitch;
        for (int32_t x = x0; x < x1; x++) {
            float front = job->knot[row + x];
            job->thickness[row + x] = front > 0.0f ? back_of(job, row + x) - front : 0.0f;
        }
    }
}

/* Between a plate's thickness and the room behind. */
static void write_run(const rlf_chord_job *job, const rlf_run *run, int32_t y)
{
    const rlf_slot *slot = job->slot;
    ptrdiff_t first = (ptrdiff_t)y * job->stage->grid.width + run->x0;
    bool is_plate = job->is_plate[run->component] != 0;
    const rlf_kernel_thickness limits = {RLF_THINNEST_M,
                                         is_plate ? RLF_THINNEST_M : RLF_THICKEST_M};
    if (!is_plate) {
        rlf_knots_spread(job, run, y);
    }
    const float *behind = job->behind != NULL ? job->behind + first : job->stage->work.zeros;
    rlf_kernel_thickness_row(&limits, slot->depth + first, behind, run->x1 - run->x0,
                             slot->thickness + first);
}

static void write_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_chord_job *job = context;
    const rlf_runs *runs = &job->stage->work.runs;
    for (int32_t y = begin; y < end; y++) {
        for (int32_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
            if (runs->run[r].component > 0) {
                write_run(job, &runs->run[r], y);
            }
        }
    }
}

void rlf_thickness_fit(rlf_chord_job *job, const rlf_rect *block)
{
    static const int32_t directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    job->x0 = block->x0;
    job->y0 = block->y0;
    job->width = block->x1 - block->x0;
    job->height = block->y1 - block->y0;
    rlf_pool *pool = job->stage->def.pool;
    rlf_chords_prepare(job);
    for (int d = 0; d < 4; d++) {
        job->dx = directions[d][0];
        job->dy = directions[d][1];
        int32_t count = rlf_line_count(job);
        rlf_parallel_for(pool, count, RLF_ROW_GRAIN, cut_lines, job);
        rlf_chords_pool(job, count);
        if (job->dy == 0 && job->is_of_people) {
            rlf_chords_align(job, count);
        }
        rlf_parallel_for(pool, count, RLF_ROW_GRAIN, paint_lines, job);
    }
    rlf_parallel_for(pool, (job->height + job->step - 1) / job->step, RLF_ROW_GRAIN, resolve_rows,
                     job);
}

void rlf_thickness_write(const rlf_chord_job *job)
{
    rlf_chord_job copy = *job; /* a parallel loop's context is not const */
    rlf_parallel_for(job->stage->def.pool, job->stage->grid.height, RLF_ROW_GRAIN, write_rows,
                     &copy);
}

rlf_rect rlf_block_of(const image_grid *grid, const rlf_region *region, int32_t step)
{
    int32_t x0 = region->x0 > step ? (region->x0 - 1) / step * step : 0;
    int32_t y0 = region->y0 > step ? (region->y0 - 1) / step * step : 0;
    int32_t x1 = region->x1 + step, y1 = region->y1 + step;
    return (rlf_rect){x0, y0, x1 < grid->width ? x1 : grid->width,
                      y1 < grid->height ? y1 : grid->height};
}

/* The block of all regions that are no plates; false when there are none. */
static bool find_block(const rlf_chord_job *job, rlf_rect *block)
{
    const rlf_slot *slot = job->slot;
    rlf_region all = {.x0 = INT32_MAX, .y0 = INT32_MAX};
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        const rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        if (!job->is_plate[r + 1]) {
            all.x0 = region->x0 < all.x0 ? region->x0 : all.x0;
            all.y0 = region->y0 < all.y0 ? region->y0 : all.y0;
            all.x1 = region->x1 > all.x1 ? region->x1 : all.x1;
            all.y1 = region->y1 > all.y1 ? region->y1 : all.y1;
        }
    }
    *block = rlf_block_of(&job->stage->grid, &all, job->step);
    return all.x1 > 0;
}

/* Which regions are flat up to noise; all, where nothing is known to be behind. */
static void find_plates(const rlf_reconstruct *stage, const rlf_slot *slot, int32_t *is_plate)
{
    bool is_all_front = stage->def.background_method == RLF_BACKGROUND_OFF;
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        const rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        is_plate[r + 1] = is_all_front || rlf_region_is_flat(stage, region);
    }
}

rlf_chord_job rlf_chord_job_make(rlf_reconstruct *stage, const rlf_slot *slot, const float *raw)
{
    const rlf_work *work = &stage->work;
    const image_grid *grid = &stage->grid;
    int32_t step = rlf_knot_step(grid), columns = (grid->width + step - 1) / step;
    return (rlf_chord_job){
        .stage = stage,
        .slot = slot,
        .is_of_people = true,
        .raw = raw,
        .behind = stage->background.mean,
        .is_plate = work->map,
        .step = step,
        .pitch = (ptrdiff_t)grid->width + RLF_CHORD_PAD,
        .front = stage->chords.front,
        .inverse = stage->chords.inverse,
        .label = stage->chords.label,
        .squares = stage->chords.squares,
        .square_pitch = grid->width / RLF_CHORD_SQUARE + 1,
        .columns = columns,
        .rows = (grid->height + step - 1) / step,
        .knot_pitch = (ptrdiff_t)columns + RLF_CHORD_PAD,
        .knot = stage->chords.knot + RLF_CHORD_PAD / 2,
        .thickness = stage->chords.thickness + RLF_CHORD_PAD / 2,
        .own = {stage->chords.solid[0], stage->chords.solid[1], stage->chords.solid[2]},
        .hidden = {stage->chords.solid[3], stage->chords.solid[4], stage->chords.solid[5]},
        .chords = stage->chords.chord,
        .counts = work->size,
        .noise = rlf_kernel_noise_make(&stage->def.rig.noise)};
}

/* The published plane holds only what was written into the slot three frames ago. Only foreground
 * and regions are given a thickness. */
static void clear_thickness(const image_grid *grid, rlf_slot *slot)
{
    for (int32_t y = 0; y < grid->height; y++) {
        ptrdiff_t row = (ptrdiff_t)y * grid->width;
        rlf_span *span = &slot->thick[y];
        memset(slot->thickness + row + span->x0, 0,
               (size_t)(span->x1 - span->x0) * sizeof *slot->thickness);
        *span = rlf_background_span(slot->foreground + row, grid->width);
    }
    for (int32_t r = 0; r < slot->foreground_region_count; r++) {
        const rlf_region *region = &slot->regions[slot->foreground_region_first + r];
        for (int32_t y = region->y0; y < region->y1; y++) {
            slot->thick[y] = rlf_span_unite(slot->thick[y], (rlf_span){region->x0, region->x1});
        }
    }
}

void rlf_thickness_estimate(rlf_reconstruct *stage, rlf_slot *slot, const float *raw)
{
    clear_thickness(&stage->grid, slot);
    find_plates(stage, slot, stage->work.map);
    rlf_chord_job job = rlf_chord_job_make(stage, slot, raw);
    rlf_rect block;
    if (find_block(&job, &block)) {
        rlf_thickness_fit(&job, &block);
    }
    rlf_thickness_write(&job);
}

void chords_allocate(chord_planes *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                     const image_grid *grid)
{
    size_t width = (size_t)grid->width, height = (size_t)grid->height;
    size_t padded = height * (width + RLF_CHORD_PAD), lines = width + height;
    arena_next_owner(arena);
    if (def->enable_thickness) {
        for (int k = 0; k < 6; k++) {
            state->solid[k] = arena_take(arena, padded, sizeof(float));
        }
        state->knot = arena_take(arena, padded, sizeof(float));
        state->chord = arena_take(arena, lines * RLF_CHORDS_PER_LINE, sizeof *state->chord);
        state->squares =
            arena_take(arena, (width / RLF_CHORD_SQUARE + 1) * (height / RLF_CHORD_SQUARE + 1), 1);
        state->front = arena_lend(arena, padded, sizeof(float));
        state->inverse = arena_lend(arena, padded, sizeof(float));
        state->thickness = arena_lend(arena, padded, sizeof(float));
        state->label = arena_lend(arena, padded, sizeof(int32_t));
    }
}
