/* Fills small holes from the right side of an edge.
 *
 * A hole pixel with a valid pixel on both sides, along its row, column or diagonal, at most
 * RLF_FILL_GAP apart, is filled. When the two ends belong to one surface, inverse depth (linear on
 * planes) is interpolated. When there is an edge between them, drivers have taken a band away whose
 * middle is the edge, ragged by a pixel on both sides. The valid pixels about the hole pixel vote,
 * near ones more, for the side that it belongs to: that averages the raggedness along the edge. The
 * depth is that side's plane, least squares in depth, which is straight enough within two pixels
 * (where nothing moves without a third surface, as there is at corners), or the background's own
 * where that goes on there. A gap between two near ends that is wider than a driver's band shows
 * the background in its middle; one between two far ends may hide a thin thing that is expected
 * there (thin/thin.h). The outermost pixels, which drivers' filters leave
 * empty, go on as the two inside of them. A hole about as wide as the widest that is filled is
 * filled in some rows and not in others: what is left of it then is closed. */
#include "surface/steps.h"
#include "surface/thin/thin.h"

#include "kernel/batch.h"

/* Share of the depth, from a side's end to a hole pixel. */
static const float MOST_CHANGE = 0.05f;

/* The same for what moves: all that is on its side of the middle. Arms and trunks are round. */
static const float MOVING_CHANGE = 1e6f;

/* Pixels from one to where the background must go on; from a hole's pixel to its end. */
enum { ABOUT_BEHIND = 3, LONGEST_HOLE = 3 * RLF_FILL_GAP };

typedef struct fill_job {
    const rlf_reconstruct *stage;
    const background_image *behind; /* the background; NULL = unknown */
    float *const *normal;           /* NULL = not wanted */
    float *depth;
    uint8_t *has; /* plane: 1 where `depth` has one that was not filled here */
    float *found; /* plane: depths for each chunk of rows, in the order of its pixels */
    uint8_t *reason;
} fill_job;

/* The background has no outline about a pixel, where its own normals would be guesses too. */
static bool is_whole(const fill_job *job, int32_t x, int32_t y)
{
    const image_grid *grid = &job->stage->grid;
    const float *at = job->behind->depth + (ptrdiff_t)y * grid->width + x;
    ptrdiff_t row = (ptrdiff_t)ABOUT_BEHIND * grid->width;
    float most = MOST_CHANGE * at[0];
    return x >= ABOUT_BEHIND && y >= ABOUT_BEHIND && x + ABOUT_BEHIND < grid->width &&
           y + ABOUT_BEHIND < grid->height && rlf_kernel_abs(at[-ABOUT_BEHIND] - at[0]) < most &&
           rlf_kernel_abs(at[ABOUT_BEHIND] - at[0]) < most &&
           rlf_kernel_abs(at[-row] - at[0]) < most && rlf_kernel_abs(at[row] - at[0]) < most;
}

/* 0 where it is unknown. */
static float depth_behind(const fill_job *job, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
    bool known = job->behind != NULL && job->behind->depth[i] > 0.0f;
    return known ? job->behind->depth[i] : 0.0f;
}

/* The pixel shows the background: it has its depth and its normal. Where the published depth is not
 * that of the model, the model's, by which the pixel would be taken for foreground otherwise. */
static float show_behind(const fill_job *job, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
    bool normals = job->normal != NULL && is_whole(job, x, y);
    for (int k = 0; k < 3 && normals; k++) {
        job->normal[k][i] = job->behind->normal[k][i];
    }
    float z = job->behind->depth[i], model = job->stage->background.mean[i];
    bool is_model = rlf_kernel_abs(z - model) < rlf_background_gate(&job->stage->def, model);
    return is_model || !(model > 0.0f) ? z : model;
}

/* Hole pixels with an end on both sides, that wait until there are enough of them for a kernel. */
typedef struct fill_queue {
    int32_t count;
    int32_t x[RLF_BATCH], y[RLF_BATCH], line[RLF_BATCH];
    rlf_gap_ends ends;
    float lost[RLF_BATCH]; /* depth of a thing that the gap hides, 0 = none */
    rlf_windows depth;
    rlf_color_sum *sum; /* of the rows that are being filled */
    float *found;       /* what comes next goes there */
} fill_queue;

/* The next pixel with depth from (x, y) is no farther than `farthest`; false when there is none. */
static bool meets_near(const fill_job *job, int32_t x, int32_t y, int32_t dx, int32_t dy,
                       float farthest)
{
    const image_grid *grid = &job->stage->grid;
    for (int32_t steps = 0; steps < LONGEST_HOLE; steps++) {
        x += dx;
        y += dy;
        ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
        if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
            return false;
        }
        if (job->has[i] != 0) {
            return job->depth[i] <= farthest;
        }
    }
    return false;
}

/* Between two near ends that are far enough apart for a slit: what a driver takes away beside each
 * edge does not reach its middle. Along it the background is seen: what is closed there too is a
 * hole in one thing, which no light came back from. */
static bool is_slit(const fill_job *job, const fill_queue *q, int32_t k)
{
    const float edge_width = 2.0f;
    const rlf_gap_ends *ends = &q->ends;
    const int32_t *line = rlf_line_step[q->line[k]];
    int32_t x = q->x[k], y = q->y[k];
    float farthest = ends->before[k] > ends->after[k] ? ends->before[k] : ends->after[k];
    bool wide = ends->to_before[k] > edge_width && ends->to_after[k] > edge_width;
    float most = (1.0f + MOST_CHANGE) * farthest;
    return wide && depth_behind(job, x, y) > most &&
           !(meets_near(job, x, y, -line[1], line[0], most) &&
             meets_near(job, x, y, line[1], -line[0], most));
}

/* Between a near end and a far one on the side where the sensor's shadow lies, the pixels beside
 * the far one are in it, whatever the pixels about them vote. `votes` < 0: the far side. */
static void vote_by_shadow(const fill_job *job, const fill_queue *q, float votes[RLF_BATCH])
{
    const float sure = 1e6f, mixed = 1.0f; /* pixels: half of what drivers drop at an edge */
    const rlf_gap_ends *ends = &q->ends;
    for (int32_t k = 0; k < q->count && job->stage->shadow.is_known; k++) {
        float before = ends->before[k], after = ends->after[k];
        int32_t along = rlf_line_step[q->line[k]][0]; /* columns, from before to after */
        if (along == 0 || !rlf_gap_is_edge(before, after, ends->to_before[k] + ends->to_after[k])) {
            continue;
        }
        bool is_after = before < after; /* the far end is */
        rlf_shadow_side side = is_after == (along > 0) ? RLF_SHADOW_RIGHT : RLF_SHADOW_LEFT;
        float near_z = is_after ? before : after, far_z = is_after ? after : before;
        float wide = rlf_shadow_width(job->stage, side, near_z, far_z);
        float away = is_after ? ends->to_after[k] : ends->to_before[k];
        votes[k] = wide >= 1.0f && away <= wide + mixed ? -sure : votes[k];
    }
}

static bool may_fill(uint8_t reason)
{
    return reason == RLF_REASON_NO_RETURN || reason == RLF_REASON_FLYING;
}

/* The nearer side stands before the background, and something moves there: of what stands still
 * the pixels that were seen are recalled. */
static bool may_ask(const fill_job *job, const fill_queue *q, int32_t k)
{
    const float least_before = 1.02f;
    const rlf_gap_ends *ends = &q->ends;
    const int32_t *line = rlf_line_step[q->line[k]];
    float before = ends->before[k], after = ends->after[k];
    float near_end = before < after ? before : after;
    int32_t steps = (int32_t)(before < after ? -ends->to_before[k] : ends->to_after[k]);
    if (!rlf_gap_is_edge(before, after, ends->to_before[k] + ends->to_after[k]) ||
        !temporal_may_move(job->stage, q->x[k], q->y[k])) {
        return false;
    }
    float behind = depth_behind(job, q->x[k] + steps * line[0], q->y[k] + steps * line[1]);
    return !(behind > 0.0f) || behind > least_before * near_end;
}

/* Adds what the colour picture says. */
static void ask_picture(const fill_job *job, fill_queue *q, float votes[RLF_BATCH])
{
    bool may[RLF_BATCH];
    for (int32_t k = 0; k < q->count; k++) {
        may[k] = may_ask(job, q, k);
    }
    const rlf_guide_cases cases = {.count = q->count,
                                   .x = q->x,
                                   .y = q->y,
                                   .line = q->line,
                                   .ends = &q->ends,
                                   .depth = &q->depth,
                                   .votes = votes};
    rlf_color_guide_vote(job->stage, &cases, may, q->sum);
}

static void fill_batch(const fill_job *job, fill_queue *q)
{
    float filled[RLF_BATCH], votes[RLF_BATCH];
    uint8_t kind[RLF_BATCH];
    rlf_kernel_fill_votes(&q->depth, &q->ends, votes);
    if (job->stage->guide.image.data != NULL) {
        ask_picture(job, q, votes);
    }
    vote_by_shadow(job, q, votes);
    rlf_kernel_fill_batch(&q->depth, &q->ends, votes, filled, kind);
    for (int32_t k = 0; k < q->count; k++) {
        int32_t x = q->x[k], y = q->y[k];
        ptrdiff_t i = (ptrdiff_t)y * job->stage->grid.width + x;
        float z = filled[k];
        bool behind =
            is_slit(job, q, k) || (kind[k] == RLF_FILL_FAR &&
                                   rlf_kernel_abs(depth_behind(job, x, y) - z) < MOST_CHANGE * z);
        bool lost = q->lost[k] > 0.0f;
        *q->found++ = lost ? q->lost[k] : behind ? show_behind(job, x, y) : z;
        job->reason[i] = RLF_REASON_FILLED;
    }
    q->count = 0;
}

static void push(const fill_job *job, int32_t x, int32_t y, const rlf_gaps *gaps, int32_t k,
                 fill_queue *q)
{
    const image_grid *grid = &job->stage->grid;
    const float *at = job->depth + (ptrdiff_t)y * grid->width + x;
    const int32_t *line = rlf_line_step[gaps->line[k]];
    ptrdiff_t step = line[0] + (ptrdiff_t)line[1] * grid->width;
    int32_t lane = q->count++;
    q->line[lane] = gaps->line[k];
    q->x[lane] = x;
    q->y[lane] = y;
    q->ends.before[lane] = at[-(ptrdiff_t)gaps->to_before[k] * step];
    q->ends.after[lane] = at[(ptrdiff_t)gaps->to_after[k] * step];
    q->ends.to_before[lane] = (float)gaps->to_before[k];
    q->ends.to_after[lane] = (float)gaps->to_after[k];
    q->ends.most_apart[lane] = temporal_may_move(job->stage, x, y) ? MOVING_CHANGE : MOST_CHANGE;
    float before = q->ends.before[lane], after = q->ends.after[lane];
    q->lost[lane] =
        thin_find_lost(&job->stage->thin, at - job->depth, before < after ? before : after);
    rlf_windows_read(job->depth, grid->width, grid->height, x, y, lane, &q->depth);
    if (q->count == RLF_BATCH) {
        fill_batch(job, q);
    }
}

/* Of sixteen pixels those that may be filled and have an end on both sides. All others have depth
 * or must not have one. */
static void find_gaps(const fill_job *job, int32_t x, int32_t y, fill_queue *q)
{
    const image_grid *grid = &job->stage->grid;
    const uint8_t *reason = job->reason + (ptrdiff_t)y * grid->width + x;
    rlf_gap_patch patch;
    rlf_gaps gaps;
    rlf_gap_patch_read(job->has, grid->width, grid->height, x, y, &patch);
    rlf_kernel_gap_patch(&patch, &gaps);
    for (int32_t k = 0; k < rlf_least(RLF_BATCH, grid->width - x); k++) {
        if (gaps.line[k] != RLF_LINE_NONE && may_fill(reason[k])) {
            push(job, x + k, y, &gaps, k, q);
        }
    }
}

static void find_holes(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    ptrdiff_t width = job->stage->grid.width, first = begin * width;
    rlf_kernel_has_row(job->depth + first, (int32_t)((end - begin) * width), job->has + first);
}

static void fill_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    int32_t width = job->stage->grid.width;
    const rlf_color_guide *side = &job->stage->guide;
    fill_queue queue = {.sum = side->part != NULL ? side->part + begin / RLF_ROW_GRAIN : NULL,
                        .found = job->found + (ptrdiff_t)begin * width};
    for (int32_t y = begin; y < end; y++) {
        const uint8_t *reason = job->reason + (ptrdiff_t)y * width; /* 0 = OK */
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, width)) < width; x++) {
            if (may_fill(reason[x])) {
                find_gaps(job, x, y, &queue);
                x += RLF_BATCH - 1;
            }
        }
    }
    fill_batch(job, &queue);
}

/* Puts in what was found, now that no window is read any more. */
static void put_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const fill_job *job = context;
    int32_t width = job->stage->grid.width;
    const float *found = job->found + (ptrdiff_t)begin * width;
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * width;
        const uint8_t *reason = job->reason + row; /* 0 = OK */
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, width)) < width; x++) {
            if (reason[x] == RLF_REASON_FILLED && job->has[row + x] == 0) {
                job->depth[row + x] = *found++;
            }
        }
    }
}

/* Pixel i of the border from the one inside of it, `step` away, and the next. */
static void go_on(const fill_job *job, ptrdiff_t i, ptrdiff_t step)
{
    float z = job->depth[i + step], next = job->depth[i + 2 * step];
    if (job->depth[i] > 0.0f || !(z > 0.0f) || !may_fill(job->reason[i])) {
        return;
    }
    bool one_surface = next > 0.0f && rlf_kernel_abs(next - z) < MOST_CHANGE * z;
    job->depth[i] = one_surface ? z * next / (2.0f * next - z) : z; /* inverse depth is linear */
    job->reason[i] = RLF_REASON_FILLED;
}

/* Rows first; the corners then have theirs. */
static void fill_border(const fill_job *job)
{
    const image_grid *grid = &job->stage->grid;
    ptrdiff_t width = grid->width, last = (ptrdiff_t)(grid->height - 1) * width;
    if (grid->width < 3 || grid->height < 3) {
        return;
    }
    for (int32_t y = 0; y < grid->height; y++) {
        go_on(job, y * width, 1);
        go_on(job, y * width + width - 1, -1);
    }
    for (int32_t x = 0; x < grid->width; x++) {
        go_on(job, x, width);
        go_on(job, last + x, -width);
    }
}

/* Closes the one or two empty pixels from i on along `step`, of `room` that there are, when one of
 * those at their ends was filled and both show one surface. */
static bool close_gap(const fill_job *job, ptrdiff_t i, ptrdiff_t step, int32_t room)
{
    enum { WIDEST = 2 };
    int32_t wide = 1;
    while (wide < WIDEST && wide < room && may_fill(job->reason[i + wide * step])) {
        wide++;
    }
    ptrdiff_t end = i + wide * step;
    if (wide >= room) {
        return false;
    }
    float z = job->depth[i - step], next = job->depth[end];
    bool was_filled =
        job->reason[i - step] == RLF_REASON_FILLED || job->reason[end] == RLF_REASON_FILLED;
    if (!was_filled || !(z > 0.0f) || !(next > 0.0f) ||
        !(rlf_kernel_abs(next - z) < MOST_CHANGE * z)) {
        return false;
    }
    for (int32_t k = 0; k < wide; k++) { /* inverse depth is linear */
        float share = (float)(k + 1) / (float)(wide + 1);
        job->depth[i + k * step] = z * next / (next + share * (z - next));
        job->reason[i + k * step] = RLF_REASON_FILLED;
    }
    return true;
}

/* In raster order, by one thread: what was closed may be an end of what follows. */
static void close_gaps(const fill_job *job)
{
    const image_grid *grid = &job->stage->grid;
    int32_t width = grid->width;
    for (int32_t y = 1; y + 1 < grid->height; y++) {
        ptrdiff_t row = (ptrdiff_t)y * width;
        for (int32_t x = 0; (x = rlf_kernel_next_mark(job->reason + row, x, width)) < width; x++) {
            if (x > 0 && x + 1 < width && may_fill(job->reason[row + x]) &&
                !close_gap(job, row + x, width, grid->height - y)) {
                close_gap(job, row + x, 1, width - x);
            }
        }
    }
}

void rlf_fill_holes(const rlf_reconstruct *stage, rlf_slot *slot, uint8_t *was_seen)
{
    rlf_pool *pool = stage->def.pool;
    int32_t height = stage->grid.height;
    fill_job job = {.stage = stage,
                    .behind = background_image_newest(stage),
                    .normal = stage->def.enable_smoothing ? slot->normal : NULL,
                    .depth = slot->depth,
                    .has = was_seen,
                    .found = stage->work.found,
                    .reason = slot->reason};
    rlf_parallel_for(pool, height, RLF_ROW_GRAIN, find_holes, &job);
    rlf_parallel_for(pool, height, RLF_ROW_GRAIN, fill_rows, &job);
    rlf_parallel_for(pool, height, RLF_ROW_GRAIN, put_rows, &job);
    close_gaps(&job);
    fill_border(&job);
}
