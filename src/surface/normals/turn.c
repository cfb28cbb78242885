/* Normals of what was seen near the outlines of things that move.
 *
 * A plane window that may not reach across an outline lies inside of it: its plane is that of a
 * place farther in, where a rounded surface faces the camera more than at the pixel, by 10 to 20
 * degrees on a limb. As in outline.c the outward component grows linearly up to 1 at the outline,
 * so what the window found is moved out to the pixel.
 *
 * What does not turn steadily but is not flat either, right beside an outline, leans out a little.
 *
 * Where the outline runs is seen from the depth within two pixels, and where there is none within
 * four. What stands still or is flat has faces, not limbs, and is left alone. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/outline.h"

#include <string.h>

enum { ABOUT = RLF_NEAR_EDGE_APART };

typedef struct turn_job {
    rlf_way way;
    const uint8_t *front;  /* not flat, a frame ago */
    const rlf_span *spans; /* per row, where it may be set */
    float *turned[3];      /* planes: normals at the marks */
    uint8_t *mark;         /* pixels that may need another normal; at last, those that have one */
} turn_job;

/* Pixels that wait until there are enough of them for a kernel. */
typedef struct turn_queue {
    int32_t count;
    rlf_way_from at;
} turn_queue;

typedef struct turn_queues {
    turn_queue near, apart, found;
    rlf_windows depth; /* about the near */
} turn_queues;

static void turn_found(const turn_job *job, turn_queue *q)
{
    rlf_way_in in;
    rlf_normals normals;
    int32_t inner[RLF_BATCH];
    rlf_kernel_way_in(&job->way, &q->at, 0, &in, inner);
    for (int32_t k = 0; k < RLF_BATCH; k++) {
        in.moves[k] = 1.0f;
    }
    rlf_kernel_outline_near(&q->at.outline, &in, &normals);
    for (int32_t k = 0; k < q->count; k++) {
        ptrdiff_t i = (ptrdiff_t)q->at.y[k] * job->way.width + q->at.x[k];
        if (normals.z[k] != 0.0f) {
            job->turned[0][i] = normals.x[k];
            job->turned[1][i] = normals.y[k];
            job->turned[2][i] = normals.z[k];
            job->mark[i] = 1;
        }
    }
    q->count = 0;
}

/* Pixel (x, y), whose outline is `distance` pixels off in a direction. */
static void push_found(const turn_job *job, turn_queue *found, int32_t x, int32_t y, float out_x,
                       float out_y, float distance)
{
    int32_t lane = found->count++;
    rlf_way_fetch(&job->way, x, y);
    found->at.x[lane] = x;
    found->at.y[lane] = y;
    found->at.outline.x[lane] = out_x;
    found->at.outline.y[lane] = out_y;
    found->at.outline.distance[lane] = distance;
    if (found->count == RLF_BATCH) {
        turn_found(job, found);
    }
}

/* The outlines of pixels whose windows show none. */
static void find_apart(const turn_job *job, turn_queues *queues)
{
    turn_queue *q = &queues->apart;
    if (q->count == 0) {
        return;
    }
    for (int32_t k = q->count; k < RLF_BATCH; k++) { /* are looked at as well */
        q->at.x[k] = q->at.x[0];
        q->at.y[k] = q->at.y[0];
    }
    rlf_outlines *outline = &q->at.outline;
    rlf_kernel_outline_apart(&job->way, &q->at, outline);
    for (int32_t k = 0; k < q->count; k++) {
        if (outline->distance[k] > 0.0f) {
            push_found(job, &queues->found, q->at.x[k], q->at.y[k], outline->x[k], outline->y[k],
                       outline->distance[k]);
        }
    }
    q->count = 0;
}

static void push_apart(const turn_job *job, int32_t x, int32_t y, turn_queues *queues)
{
    turn_queue *q = &queues->apart;
    int32_t lane = q->count++;
    rlf_way_fetch(&job->way, x, y);
    q->at.x[lane] = x;
    q->at.y[lane] = y;
    if (q->count == RLF_BATCH) {
        find_apart(job, queues);
    }
}

static void find_outlines(const turn_job *job, turn_queues *queues)
{
    turn_queue *q = &queues->near;
    const rlf_outlines *outline = &q->at.outline;
    rlf_kernel_outline_find(&queues->depth, RLF_OUTLINE_STEP_SEEN, &q->at.outline);
    for (int32_t k = 0; k < q->count; k++) {
        if (outline->distance[k] > 0.0f) {
            push_found(job, &queues->found, q->at.x[k], q->at.y[k], outline->x[k], outline->y[k],
                       outline->distance[k]);
        } else {
            push_apart(job, q->at.x[k], q->at.y[k], queues);
        }
    }
    q->count = 0;
}

/* Whether something is behind pixel i at the ends of its window, without which no outline is found
 * there. */
static bool ends_in_window(const rlf_way *way, ptrdiff_t i)
{
    const float *z = way->depth + i;
    const ptrdiff_t across = RLF_WINDOW_ABOUT, down = across * way->width;
    float behind = z[0] * (1.0f + RLF_OUTLINE_STEP_SEEN);
    return (z[-across] > behind) | (z[across] > behind) | (z[-down] > behind) | (z[down] > behind);
}

/* Pixels of row y that something in front may have been about. */
static rlf_span span_about(const turn_job *job, int32_t y)
{
    rlf_span span = rlf_span_unite(job->spans[y - ABOUT], job->spans[y + ABOUT]);
    span = rlf_span_unite(span, job->spans[y]);
    if (span.x0 < span.x1) {
        span.x0 = span.x0 > 2 * ABOUT ? span.x0 - ABOUT : ABOUT;
        span.x1 = rlf_least(span.x1 + ABOUT, job->way.width - ABOUT);
    }
    return span;
}

/* Marks what was seen of row y near outlines of what is in front. */
static void mark_row(const turn_job *job, int32_t y, rlf_span span, uint8_t *mark)
{
    enum { TOGETHER = 64 };
    ptrdiff_t width = job->way.width, row = y * width;
    const uint8_t *front = job->front + row, *known = job->way.known + row;
    rlf_kernel_was_front_row(front, known, width, span.x0, span.x1, mark);
    for (int32_t x = span.x0; (x = rlf_kernel_next_mark(mark, x, span.x1)) < span.x1;
         x += TOGETHER) {
        int32_t end = rlf_least(x + TOGETHER, span.x1);
        rlf_kernel_near_edge_row(job->way.depth + row, width, x, end, mark);
    }
}

static void turn_row(const turn_job *job, int32_t y, turn_queues *queues)
{
    const rlf_way *way = &job->way;
    ptrdiff_t row = (ptrdiff_t)y * way->width;
    uint8_t *mark = job->mark + row;
    turn_queue *q = &queues->near;
    rlf_span span = span_about(job, y);
    mark_row(job, y, span, mark);
    for (int32_t x = span.x0; (x = rlf_kernel_next_mark(mark, x, span.x1)) < span.x1; x++) {
        mark[x] = 0;
        if (!ends_in_window(way, row + x)) {
            push_apart(job, x, y, queues);
            continue;
        }
        int32_t lane = q->count++;
        q->at.x[lane] = x;
        q->at.y[lane] = y;
        rlf_windows_read(way->depth, way->width, way->height, x, y, lane, &queues->depth);
        if (q->count == RLF_BATCH) {
            find_outlines(job, queues);
        }
    }
}

static void turn_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const turn_job *job = context;
    turn_queues queues;
    memset(&queues, 0, sizeof queues);
    for (int32_t y = begin; y < end; y++) {
        memset(job->mark + (ptrdiff_t)y * job->way.width, 0, (size_t)job->way.width);
        bool inside = y >= ABOUT && y + ABOUT < job->way.height && job->way.width > 2 * ABOUT;
        if (inside) {
            turn_row(job, y, &queues);
        }
    }
    find_outlines(job, &queues);
    find_apart(job, &queues);
    turn_found(job, &queues.found);
}

/* Afterwards, so that no pixel reads what another was given. */
static void write_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const turn_job *job = context;
    ptrdiff_t first = (ptrdiff_t)begin * job->way.width;
    const uint8_t *mark = job->mark + first;
    int32_t count = (end - begin) * job->way.width;
    for (int32_t i = 0; (i = rlf_kernel_next_mark(mark, i, count)) < count; i++) {
        for (int32_t k = 0; k < 3; k++) {
            job->way.normal[k][first + i] = job->turned[k][first + i];
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

const uint8_t *rlf_normals_rounded_front(const rlf_reconstruct *stage)
{
    const rlf_slot *before = stage->previous;
    if (before == NULL) {
        return NULL;
    }
    const uint8_t *front = before->foreground;
    uint8_t *rounded = stage->work.links;
    for (int32_t r = 0; r < before->foreground_region_count; r++) {
        const rlf_region *region = &before->regions[before->foreground_region_first + r];
        if (rlf_region_is_flat(stage, region)) {
            if (front != rounded) {
                memcpy(rounded, front, (size_t)stage->grid.count);
                front = rounded;
            }
            leave_out(before, region, stage->grid.width, rounded);
        }
    }
    return front;
}

void rlf_normals_turn(const rlf_reconstruct *stage, const rlf_slot *slot, const uint8_t *rounded)
{
    const rlf_grid *grid = &stage->grid;
    if (rounded == NULL) {
        return;
    }
    const rlf_work *work = &stage->work;
    turn_job job = {{grid->width, grid->height, grid->ray_x, grid->ray_y, slot->depth,
                     work->mask[0], slot->normal},
                    rounded,
                    work->front,
                    {work->depth[0], work->sum[0], work->sum[1]},
                    work->mask[1]};
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, turn_rows, &job);
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, write_rows, &job);
}
