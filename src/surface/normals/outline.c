/* Normals of filled pixels at the outlines of things.
 *
 * Where a smooth surface turns out of sight its normal is perpendicular to the ray and, in the
 * image, points across the outline (Koenderink 1984). The sensor drops just these pixels, and the
 * windows that fit next to them know only the part that faces the camera. Along the way out, the
 * outward component of a circle's or a ball's unit normal grows linearly with the position in the
 * image, up to 1 at the outline. So a filled pixel's normal lies between the mean of those that are
 * known further in and the outline's, if these already turn outwards.
 *
 * Things with faces turn at a crease. What is left of a narrow last face is a pixel here and there:
 * the outermost known normal stands for it. Of what moves and is neither flat nor seen to turn, as
 * where two limbs meet, it is the mean of what is known, which lies farther in, turned outwards. */
#include "surface/steps.h"
#include "surface/window.h"

#include "kernel/outline.h"
#include "surface/normals/side.h"

#include <string.h>

static const float MOST_APART = 0.04f; /* share of the depth, of pixels of one surface */

typedef struct outline_job {
    rlf_way way; /* normals of what is known are read, those of what was filled are written */
    const uint8_t *reason;
    const rlf_side_job *side;
    const uint8_t *front; /* that is not flat, a frame ago; NULL = nothing is known to be */
} outline_job;

/* Pixels that wait until there are enough of them for a kernel. */
typedef struct outline_queue {
    int32_t count;
    rlf_way_from at;
    rlf_normals aside;
    float rounded[RLF_BATCH]; /* 1 where something that is not flat was in front, else 0 */
} outline_queue;

/* Filled pixels, those of them that have an outline, and of these those that are not rounded. */
typedef struct outline_queues {
    outline_queue filled, found, faces;
    rlf_windows depth; /* about the filled */
} outline_queues;

static void push(outline_queue *q, int32_t x, int32_t y, const rlf_outlines *outline, int32_t k)
{
    int32_t i = q->count++;
    q->at.x[i] = x;
    q->at.y[i] = y;
    q->at.outline.x[i] = outline->x[k];
    q->at.outline.y[i] = outline->y[k];
    q->at.outline.distance[i] = outline->distance[k];
}

static bool is_set(const rlf_normals *n, int32_t k)
{
    return n->x[k] != 0.0f || n->y[k] != 0.0f || n->z[k] != 0.0f;
}

static void write_normal(const outline_job *job, ptrdiff_t i, const rlf_normals *n, int32_t k)
{
    job->way.normal[0][i] = n->x[k];
    job->way.normal[1][i] = n->y[k];
    job->way.normal[2][i] = n->z[k];
}

/* ---- rounded ---- */

/* Pixel (x, y), or `inner`, what is seen of its surface, was not the background in the frame
 * before, or something moves about it. */
static bool may_be_front(const rlf_reconstruct *stage, int32_t x, int32_t y, ptrdiff_t inner)
{
    const rlf_slot *before = stage->previous;
    ptrdiff_t i = (ptrdiff_t)y * stage->grid.width + x;
    return before != NULL && (before->foreground[i] != 0 || before->foreground[inner] != 0 ||
                              rlf_hold_may_move(stage, x, y));
}

static void walk_in(const outline_job *job, outline_queue *q, rlf_way_in *restrict in)
{
    int32_t inner[RLF_BATCH];
    rlf_kernel_way_in(&job->way, &q->at, 1, in, inner);
    for (int32_t k = 0; k < q->count; k++) {
        bool is_front = may_be_front(job->side->stage, q->at.x[k], q->at.y[k], inner[k]);
        in->moves[k] = is_front ? 1.0f : 0.0f;
        ptrdiff_t i = (ptrdiff_t)q->at.y[k] * job->way.width + q->at.x[k];
        bool is_rounded = job->front != NULL && (job->front[i] | job->front[inner[k]]) != 0;
        q->rounded[k] = is_rounded ? 1.0f : 0.0f;
    }
}

/* ---- faces ---- */

/* Normals of what was seen of the pixel's surface. Others are not read: they may be written. */
static void read_window(const outline_job *job, int32_t x, int32_t y, int32_t k,
                        rlf_normals *restrict window)
{
    ptrdiff_t middle = (ptrdiff_t)y * job->way.width + x;
    const float *depth = job->way.depth + middle;
    const uint8_t *known = job->way.known + middle;
    const float *nx = job->way.normal[0] + middle, *ny = job->way.normal[1] + middle,
                *nz = job->way.normal[2] + middle;
    rlf_window_places p = rlf_window_places_make(job->way.width, job->way.height, x, y);
    float z = depth[0], most = MOST_APART * z;
    for (int32_t r = 0; r < RLF_WINDOW_SIDE; r++) {
        for (int32_t c = 0; c < RLF_WINDOW_SIDE; c++) {
            ptrdiff_t i = p.row[r] + p.column[c];
            float inside = p.row_inside[r] * p.column_inside[c];
            float near = rlf_kernel_abs(depth[i] - z) < most ? inside : 0.0f;
            float weight = known[i] != 0 ? near : 0.0f;
            ptrdiff_t from = known[i] != 0 ? i : 0;
            rlf_normals *to = &window[r * RLF_WINDOW_SIDE + c];
            to->x[k] = weight * nx[from];
            to->y[k] = weight * ny[from];
            to->z[k] = weight * nz[from];
        }
    }
}

static void turn_faces(const outline_job *job, outline_queue *q)
{
    rlf_normals window[RLF_WINDOW_SIZE], normals;
    for (int32_t k = 0; k < q->count; k++) {
        read_window(job, q->at.x[k], q->at.y[k], k, window);
    }
    rlf_kernel_outline_face(&q->at.outline, &q->aside, window, q->rounded, &normals);
    for (int32_t k = 0; k < q->count; k++) {
        if (is_set(&normals, k)) {
            write_normal(job, (ptrdiff_t)q->at.y[k] * job->way.width + q->at.x[k], &normals, k);
        }
    }
    q->count = 0;
}

static void turn_found(const outline_job *job, outline_queues *queues)
{
    outline_queue *q = &queues->found, *faces = &queues->faces;
    rlf_way_in in;
    rlf_normals normals;
    walk_in(job, q, &in);
    rlf_kernel_outline_round(&q->at.outline, &in, &normals, &q->aside);
    for (int32_t k = 0; k < q->count; k++) {
        if (is_set(&normals, k)) {
            write_normal(job, (ptrdiff_t)q->at.y[k] * job->way.width + q->at.x[k], &normals, k);
            continue;
        }
        faces->rounded[faces->count] = q->rounded[k];
        faces->aside.x[faces->count] = q->aside.x[k];
        faces->aside.y[faces->count] = q->aside.y[k];
        faces->aside.z[faces->count] = q->aside.z[k];
        push(faces, q->at.x[k], q->at.y[k], &q->at.outline, k);
        if (faces->count == RLF_BATCH) {
            turn_faces(job, faces);
        }
    }
    q->count = 0;
}

static bool is_filled(const outline_job *job, ptrdiff_t i)
{
    return job->reason[i] == RLF_REASON_FILLED && job->way.known[i] == 0;
}

static void find_outlines(const outline_job *job, outline_queues *queues)
{
    outline_queue *q = &queues->filled;
    rlf_kernel_outline_find(&queues->depth, RLF_OUTLINE_STEP_FILLED, &q->at.outline);
    for (int32_t k = 0; k < q->count; k++) {
        bool has_outline = q->at.outline.distance[k] > 0.0f;
        if (has_outline && !rlf_side_find(job->side, q->at.x[k], q->at.y[k], q->at.outline.x[k],
                                          q->at.outline.y[k])) {
            rlf_way_fetch(&job->way, q->at.x[k], q->at.y[k]);
            push(&queues->found, q->at.x[k], q->at.y[k], &q->at.outline, k);
            if (queues->found.count == RLF_BATCH) {
                turn_found(job, queues);
            }
        }
    }
    q->count = 0;
}

static void take_filled(const outline_job *job, int32_t x, int32_t y, outline_queues *queues)
{
    outline_queue *q = &queues->filled;
    int32_t lane = q->count++;
    q->at.x[lane] = x;
    q->at.y[lane] = y;
    rlf_windows_read(job->way.depth, job->way.width, job->way.height, x, y, lane, &queues->depth);
    if (q->count == RLF_BATCH) {
        find_outlines(job, queues);
    }
}

static void outline_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const outline_job *job = context;
    outline_queues queues = {0};
    for (int32_t y = begin; y < end; y++) {
        ptrdiff_t row = (ptrdiff_t)y * job->way.width;
        const uint8_t *reason = job->reason + row; /* 0 = OK */
        memset(job->side->mark + row, 0, (size_t)job->way.width);
        for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, job->way.width)) < job->way.width;
             x++) {
            if (is_filled(job, row + x)) {
                take_filled(job, x, y, &queues);
            }
        }
    }
    find_outlines(job, &queues);
    turn_found(job, &queues);
    turn_faces(job, &queues.faces);
}

void rlf_normals_outline(const rlf_reconstruct *stage, const rlf_slot *slot, const uint8_t *rounded)
{
    const rlf_grid *grid = &stage->grid;
    rlf_side_job side = rlf_side_job_make(stage, slot);
    const rlf_way way = {grid->width, grid->height, grid->ray_x, grid->ray_y,
                         slot->depth, side.known,   slot->normal};
    outline_job job = {way, slot->reason, &side, rounded};
    rlf_parallel_for(stage->def.pool, grid->height, RLF_ROW_GRAIN, outline_rows, &job);
    rlf_side_spread(&side);
}
