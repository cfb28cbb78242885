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

/* ---- what lines say of each other ----
 *
 * What the lines beside a chord say about its body.
 *
 * Its shape: sums are pooled with those of the neighbours, which count less the farther they are.
 * The depth of its middle: a row's front says less about it than the rows above and below do
 * together. Trunks and limbs have axes, whose depth changes little from row to row. Two sweeps,
 * down and up, carry it from chord to chord as a Kalman filter and smoother do. */

static const float pooled_share = 0.6f; /* of the sums of a line a pixel away */
static const float alike = 0.7f;        /* overlap of chords with one shape ... */
static const float one_axis = 0.5f;     /* ... and with one axis, of both together */
static const float drift_m = 0.005f;    /* of the axis, from one row of pixels to the next */
static const float unlike_m = 0.04f;    /* more where chords differ in width */

/* What one line takes from the one beside it: `other` is the chord there that has most in common
 * with c, such a share of both together. */
typedef void take_fn(const rlf_chord_job *job, rlf_chord *c, const rlf_chord *other, float share);

static const rlf_chord *counterpart(const rlf_chord *c, const rlf_chord *of, int32_t count,
                                    float shift, float *best_share)
{
    const rlf_chord *best = NULL;
    *best_share = 0.0f;
    for (int32_t i = 0; i < count; i++) {
        float begin = of[i].begin + shift, end = of[i].end + shift;
        float shared = (end < c->end ? end : c->end) - (begin > c->begin ? begin : c->begin);
        float whole = (end > c->end ? end : c->end) - (begin < c->begin ? begin : c->begin);
        if (of[i].label == c->label && shared > *best_share * whole) {
            *best_share = shared / whole;
            best = &of[i];
        }
    }
    return best;
}

/* One pass over the lines, each taking from the one before. */
static void sweep(const rlf_chord_job *job, int32_t from, int32_t to, int32_t step, take_fn *take)
{
    for (int32_t line = from; line != to; line += step) {
        rlf_chord *chords = &job->chords[(ptrdiff_t)line * RLF_CHORDS_PER_LINE];
        const rlf_chord *before = NULL;
        int32_t count = 0;
        float shift = 0.0f;
        if (line != from) {
            before = &job->chords[(ptrdiff_t)(line - step) * RLF_CHORDS_PER_LINE];
            count = job->counts[line - step];
            shift = rlf_line_origin(job, line - step) - rlf_line_origin(job, line);
        }
        for (int32_t i = 0; i < job->counts[line]; i++) {
            float share;
            const rlf_chord *other = counterpart(&chords[i], before, count, shift, &share);
            take(job, &chords[i], other, share);
        }
    }
}

static void add_moments(rlf_chord_moments *to, const rlf_chord_moments *m, float share)
{
    to->ss += share * m->ss;
    to->hh += share * m->hh;
    to->sh += share * m->sh;
    to->sy += share * m->sy;
    to->hy += share * m->hy;
}

/* Forgets exponentially. */
static void take_shape(const rlf_chord_job *job, rlf_chord *c, const rlf_chord *other, float share)
{
    const float q = pooled_share;
    bool is_every = job->step == 1;
    c->running = c->own;
    if (share > alike) {
        /* a line stands for half of those beside it that are left out */
        float beside = is_every ? q : (0.5f * q + q * q + 0.5f * q * q * q) / (1.0f + q);
        add_moments(&c->running, &other->running, is_every ? q : q * q);
        add_moments(&c->pooled, &other->running, beside);
    }
}

static rlf_chord_middle fuse(rlf_chord_middle a, rlf_chord_middle b)
{
    float weight = a.weight + b.weight;
    float depth = a.weight * a.depth + b.weight * b.depth;
    return (rlf_chord_middle){weight > 0.0f ? depth / weight : 0.0f, weight};
}

static void take_middle(const rlf_chord_job *job, rlf_chord *c, const rlf_chord *other, float share)
{
    rlf_chord_middle predicted = {0.0f, 0.0f};
    if (share > one_axis) {
        float unlike = unlike_m * (1.0f - share), drift2 = (float)job->step * drift_m * drift_m;
        float variance = 1.0f / other->filtered.weight + drift2 + unlike * unlike;
        predicted = (rlf_chord_middle){other->filtered.depth, 1.0f / variance};
    }
    c->filtered = fuse(c->seen, predicted);
    c->beside = fuse(c->beside, predicted);
}

/* Adds to each chord what its neighbours on the lines beside it say about its shape. */
static void pool_shapes(const rlf_chord_job *job, int32_t line_count)
{
    for (int32_t line = 0; line < line_count; line++) {
        for (int32_t i = 0; i < job->counts[line]; i++) {
            rlf_chord *c = &job->chords[(ptrdiff_t)line * RLF_CHORDS_PER_LINE + i];
            c->pooled = c->own;
        }
    }
    sweep(job, 0, line_count, 1, take_shape);
    sweep(job, line_count - 1, -1, -1, take_shape);
}

/* Tells each chord where the rows above and below have the middle of its body. */
static void align_middles(const rlf_chord_job *job, int32_t row_count)
{
    for (int32_t row = 0; row < row_count; row++) {
        for (int32_t i = 0; i < job->counts[row]; i++) {
            rlf_chord *c = &job->chords[(ptrdiff_t)row * RLF_CHORDS_PER_LINE + i];
            c->seen = rlf_chord_middle_seen(c);
        }
    }
    sweep(job, 0, row_count, 1, take_middle);
    sweep(job, row_count - 1, -1, -1, take_middle);
}

/* ---- solids ---- */

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
        pool_shapes(job, count);
        if (job->dy == 0 && job->is_of_people) {
            align_middles(job, count);
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
