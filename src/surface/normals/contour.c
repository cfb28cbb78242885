/* Normals at depth contours: of pixels that were filled beside one, and of what was seen near the
 * contour of something that moves and is not flat.
 *
 * The sensor drops just the pixels where a surface turns out of sight, and the windows of planes
 * beside them lie inside of the contour, where it faces the camera more: by 10 to 20 degrees on a
 * limb. So a normal is read off what is known on the way in (contour_kernel.c):
 *
 * - what turns steadily outwards goes on turning, up to square to the ray at the contour;
 * - things with faces turn at a crease: the outermost known normal stands for the last face;
 * - what moves and is neither flat nor turns, as where two limbs meet, leans out a little.
 *
 * Narrow faces that no window fits are told by what the means over time show (contour_side.c).
 * Where the contour is, is seen within two pixels, and of what moves within four. */
#include "surface/normals/contour.h"

#include <string.h>

/* Marks of pixels with a new normal. That of a side tells the offset to the last pixel on the way
 * in that has it, too, at most CONTOUR_DROPPED pixels off in both directions. */
enum { LEANS = 1, SIDE = 2, OFFSETS = 1 + 2 * CONTOUR_DROPPED };

typedef struct contour_job {
    contour_sides sides;
    const uint8_t *reason;
    const uint8_t *front;  /* where something not flat was, a frame ago; NULL = nothing was known */
    const rlf_span *spans; /* per row, where it may be set */
    contour_scratch out;
} contour_job;

/* Pixels that wait until there are enough of them for a kernel. */
typedef struct contour_queues {
    contour_batch looked_at, found;
} contour_queues;

static void write_normal(const contour_job *job, ptrdiff_t i, const float normal[3], uint8_t mark)
{
    for (int k = 0; k < 3; k++) {
        job->out.normal[k][i] = normal[k];
    }
    job->out.mark[i] = mark;
}

/* The pixel, or the last one of its surface on the way in, was not the background a frame ago, or
 * something moves about it. */
static bool may_move(const contour_job *job, int32_t x, int32_t y, ptrdiff_t i, ptrdiff_t inner)
{
    const rlf_slot *before = job->sides.stage->previous;
    return before != NULL && (before->foreground[i] != 0 || before->foreground[inner] != 0 ||
                              temporal_may_move(job->sides.stage, x, y));
}

static void lean_found(const contour_job *job, contour_batch *found)
{
    contour_way way;
    contour_normals normals;
    contour_walk_in(&job->sides.planes, &job->sides.step, found, &way);
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        ptrdiff_t i = (ptrdiff_t)found->y[k] * job->sides.planes.width + found->x[k];
        bool is_round = job->front != NULL && (job->front[i] | job->front[way.inner[k]]) != 0;
        bool is_seen = job->sides.planes.known[i] != 0;
        way.moves[k] = is_seen || may_move(job, found->x[k], found->y[k], i, way.inner[k]);
        way.is_round[k] = is_seen || is_round;
    }
    contour_lean_out(found, &way, &normals);
    for (int32_t k = 0; k < found->count; k++) {
        const float normal[3] = {normals.x[k], normals.y[k], normals.z[k]};
        if (normal[2] != 0.0f) {
            write_normal(job, (ptrdiff_t)found->y[k] * job->sides.planes.width + found->x[k],
                         normal, LEANS);
        }
    }
    found->count = 0;
}

/* Filled pixel i is on a narrow side. */
static bool find_side(const contour_job *job, const contour_batch *q, int32_t k, ptrdiff_t i)
{
    float side[3];
    int32_t width = job->sides.planes.width;
    ptrdiff_t last = i;
    if (!contour_side_find(&job->sides, q->x[k], q->y[k], q->out_x[k], q->out_y[k], side, &last)) {
        return false;
    }
    int32_t dx = (int32_t)(last % width) - q->x[k], dy = (int32_t)(last / width) - q->y[k];
    int32_t offset = (dy + CONTOUR_DROPPED) * OFFSETS + dx + CONTOUR_DROPPED;
    write_normal(job, i, side, (uint8_t)(last == i ? LEANS : SIDE + offset));
    return true;
}

static void find_contours(const contour_job *job, contour_queues *queues)
{
    contour_batch *q = &queues->looked_at, *found = &queues->found;
    contour_find(&job->sides.step, q);
    for (int32_t k = 0; k < q->count; k++) {
        ptrdiff_t i = (ptrdiff_t)q->y[k] * job->sides.planes.width + q->x[k];
        if (!(q->distance[k] > 0.0f) ||
            (job->sides.planes.known[i] == 0 && find_side(job, q, k, i))) {
            continue;
        }
        int32_t to = found->count++;
        found->x[to] = q->x[k];
        found->y[to] = q->y[k];
        found->out_x[to] = q->out_x[k];
        found->out_y[to] = q->out_y[k];
        found->distance[to] = q->distance[k];
        if (found->count == RLF_BATCH) {
            lean_found(job, found);
        }
    }
    q->count = 0;
}

static void look_at(const contour_job *job, int32_t x, int32_t y, int32_t spacing,
                    contour_queues *queues)
{
    contour_batch *q = &queues->looked_at;
    ptrdiff_t width = job->sides.planes.width, about = RLF_WINDOW_ABOUT;
    int32_t lane = q->count++;
    q->x[lane] = x;
    q->y[lane] = y;
    q->spacing[lane] = (float)spacing;
    for (int32_t k = 0; k < RLF_WINDOW_SIZE; k++) {
        ptrdiff_t dx = k % RLF_WINDOW_SIDE - about, dy = k / RLF_WINDOW_SIDE - about;
        q->depth.at[k][lane] =
            job->sides.planes.depth[(y + spacing * dy) * width + x + spacing * dx];
    }
    if (q->count == RLF_BATCH) {
        find_contours(job, queues);
    }
}

/* Something is behind pixel i at the ends of its window. */
static bool ends_within(const contour_job *job, ptrdiff_t i)
{
    const float *z = job->sides.planes.depth + i;
    const depth_step *step = &job->sides.step;
    const ptrdiff_t about = RLF_WINDOW_ABOUT, down = about * job->sides.planes.width;
    return contour_is_behind(step, z[0], z[-about], z[about], (float)about) ||
           contour_is_behind(step, z[0], z[-down], z[down], (float)about);
}

/* Pixels of row y that something in front may have been about. */
static rlf_span span_about(const contour_job *job, int32_t y)
{
    enum { ABOUT = CONTOUR_REACH, BORDER = CONTOUR_BORDER };
    rlf_span span = rlf_span_unite(job->spans[y - ABOUT], job->spans[y + ABOUT]);
    span = rlf_span_unite(span, job->spans[y]);
    if (span.x0 < span.x1) {
        span.x0 = span.x0 > BORDER + ABOUT ? span.x0 - ABOUT : BORDER;
        span.x1 = rlf_least(span.x1 + ABOUT, job->sides.planes.width - BORDER);
    }
    return span;
}

/* What was seen of row y near contours of what is in front. */
static void look_at_seen(const contour_job *job, int32_t y, contour_queues *queues)
{
    const contour_planes *planes = &job->sides.planes;
    ptrdiff_t row = (ptrdiff_t)y * planes->width;
    uint8_t *mark = job->out.mark + row;
    rlf_span span = span_about(job, y);
    contour_mark_row(planes->depth + row, job->front + row, planes->known + row, &job->sides.step,
                     planes->width, span.x0, span.x1, mark);
    for (int32_t x = span.x0; (x = rlf_kernel_next_mark(mark, x, span.x1)) < span.x1; x++) {
        mark[x] = 0;
        look_at(job, x, y, ends_within(job, row + x) ? 1 : 2, queues);
    }
}

static void look_at_filled(const contour_job *job, int32_t y, contour_queues *queues)
{
    ptrdiff_t row = (ptrdiff_t)y * job->sides.planes.width;
    const uint8_t *reason = job->reason + row; /* 0 = OK */
    int32_t end = job->sides.planes.width - CONTOUR_BORDER;
    for (int32_t x = CONTOUR_BORDER; (x = rlf_kernel_next_mark(reason, x, end)) < end; x++) {
        if (reason[x] == RLF_REASON_FILLED && job->sides.planes.known[row + x] == 0) {
            look_at(job, x, y, 1, queues);
        }
    }
}

static void find_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const contour_job *job = context;
    const contour_planes *planes = &job->sides.planes;
    contour_queues queues;
    memset(&queues, 0, sizeof queues);
    for (int32_t y = begin; y < end; y++) {
        memset(job->out.mark + (ptrdiff_t)y * planes->width, 0, (size_t)planes->width);
        if (y < CONTOUR_BORDER || y >= planes->height - CONTOUR_BORDER ||
            planes->width <= 2 * CONTOUR_BORDER) {
            continue;
        }
        if (job->front != NULL) {
            look_at_seen(job, y, &queues);
        }
        look_at_filled(job, y, &queues);
    }
    find_contours(job, &queues);
    lean_found(job, &queues.found);
}

/* Afterwards, so that no pixel reads what another was given. */
static void write_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const contour_job *job = context;
    ptrdiff_t first = (ptrdiff_t)begin * job->sides.planes.width;
    const uint8_t *mark = job->out.mark + first;
    int32_t count = (end - begin) * job->sides.planes.width;
    for (int32_t i = 0; (i = rlf_kernel_next_mark(mark, i, count)) < count; i++) {
        for (int32_t k = 0; k < 3; k++) {
            job->sides.planes.normal[k][first + i] = job->out.normal[k][first + i];
        }
    }
}

/* The pixels of a side from its outermost one, pixel i, inwards. */
static void spread_side(const contour_job *job, ptrdiff_t i)
{
    int32_t offset = job->out.mark[i] - SIDE;
    int32_t dx = offset % OFFSETS - CONTOUR_DROPPED, dy = offset / OFFSETS - CONTOUR_DROPPED;
    int32_t across = dx < 0 ? -dx : dx, down = dy < 0 ? -dy : dy;
    int32_t steps = across > down ? across : down;
    for (int32_t k = 1; k <= steps; k++) {
        ptrdiff_t at = i + (ptrdiff_t)(dy * k / steps) * job->sides.planes.width + dx * k / steps;
        for (int32_t n = 0; n < 3; n++) {
            job->sides.planes.normal[n][at] = job->out.normal[n][i];
        }
    }
}

/* One after another: two sides may meet. */
static void spread_sides(const contour_job *job)
{
    int32_t count = job->sides.planes.width * job->sides.planes.height;
    for (int32_t i = 0; (i = rlf_kernel_next_mark(job->out.mark, i, count)) < count; i++) {
        if (job->out.mark[i] >= SIDE) {
            spread_side(job, i);
        }
    }
}

/* Takes away the region's pixels. */
static void leave_out(const rlf_slot *slot, const rlf_region *region, int32_t width, uint8_t *front)
{
    for (int32_t y = region->y0; y < region->y1; y++) {
        const int32_t *label = slot->label + (ptrdiff_t)y * width;
        uint8_t *row = front + (ptrdiff_t)y * width;
        for (int32_t x = region->x0; x < region->x1; x++) {
            row[x] = label[x] == region->label ? 0 : row[x];
        }
    }
}

/* Where something that is not flat was in front a frame ago, in `plane` or where it is kept; NULL =
 * there was no frame. */
static const uint8_t *find_front(const rlf_reconstruct *stage, uint8_t *plane)
{
    const rlf_slot *before = stage->previous;
    if (before == NULL) {
        return NULL;
    }
    const uint8_t *front = before->foreground;
    for (int32_t r = 0; r < before->foreground_region_count; r++) {
        const rlf_region *region = &before->regions[before->foreground_region_first + r];
        if (rlf_region_is_flat(stage, region)) {
            if (front != plane) {
                memcpy(plane, front, (size_t)stage->grid.count);
                front = plane;
            }
            leave_out(before, region, stage->grid.width, plane);
        }
    }
    return front;
}

void rlf_normals_contour(const rlf_reconstruct *stage, const rlf_slot *slot, const uint8_t *known,
                         const contour_scratch *scratch)
{
    const image_grid *grid = &stage->grid;
    const contour_planes planes = {grid->width, grid->height, grid->ray_x, grid->ray_y,
                                   slot->depth, known,        slot->normal};
    const contour_sides sides = {.stage = stage,
                                 .planes = planes,
                                 .mean = stage->temporal.mean,
                                 .frames = stage->temporal.frames,
                                 .step = depth_step_make(&stage->def.rig.noise, grid->camera.fx)};
    contour_job job = {.sides = sides,
                       .reason = slot->reason,
                       .front = find_front(stage, scratch->front),
                       .spans = stage->work.front,
                       .out = *scratch};
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, find_rows, &job);
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, write_rows, &job);
    spread_sides(&job);
}
