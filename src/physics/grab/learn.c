/* Remembers how a hand looks when it grabs: points of its surface and of its outline. */
#include "physics/grab/grab.h"

#define SAMPLES_PER_SIDE 28
/* What is this near a grabbed body is the hand that holds it: fingers and palm, metres. */
#define HAND_M 0.08
/* An outline's direction is told from so many rows or columns to both sides. */
#define BESIDE 2
#define BESIDE_SHIFT_MAX 6 /* pixels that it may go aside there */

typedef struct learn_job {
    const grid_query *query;
    const phys_shape *shape;
    phys_grab *grab;
    rlf_pose T_grid_hand;
} learn_job;

static bool is_of_hand(const learn_job *job, int32_t x, int32_t y, rlf_vec3 *place)
{
    field_cell cell;
    rlf_vec3 gradient;
    if (!grid_cell_read(job->query->grid, &job->query->grid->foreground, x, y, &cell)) {
        return false;
    }
    *place = rlf_transform_inverse(&job->T_grid_hand, cell.point);
    return phys_shape_distance(job->shape, *place, &gradient) < HAND_M;
}

/* The rim nearest to pixel (x, y) along the crossing's line; INT32_MAX when there is none. */
static int32_t rim_beside(const rlf_grid *grid, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    for (int32_t k = 0; k <= BESIDE_SHIFT_MAX; k++) {
        if (grab_is_rim(grid, x + k * dx, y + k * dy, dx, dy)) {
            return k;
        }
        if (grab_is_rim(grid, x - k * dx, y - k * dy, dx, dy)) {
            return -k;
        }
    }
    return INT32_MAX;
}

/* The outline at pixel (x, y), that leaves the hand along (dx, dy). */
static void add_rim(learn_job *job, int32_t x, int32_t y, int32_t dx, int32_t dy)
{
    phys_grab *grab = job->grab;
    const rlf_grid *grid = job->query->grid;
    rlf_vec3 place;
    if (grab->rim_count == GRAB_RIMS_MAX || !grab_is_rim(grid, x, y, dx, dy) ||
        !is_of_hand(job, x, y, &place)) {
        return;
    }
    int32_t sx = dy != 0 ? BESIDE : 0, sy = dx != 0 ? BESIDE : 0, step = dx + dy;
    int32_t before = rim_beside(grid, x - sx, y - sy, dx, dy);
    int32_t after = rim_beside(grid, x + sx, y + sy, dx, dy);
    if (before == INT32_MAX || after == INT32_MAX) {
        return;
    }
    double slope = (double)(step * (after - before)) / (2.0 * BESIDE);
    double length = sqrt(1.0 + slope * slope);
    grab_rim *rim = &grab->rims[grab->rim_count++];
    rim->point = place;
    rim->step = step;
    rim->is_of_column = dy != 0;
    rim->along[rim->is_of_column] = 1.0 / length;
    rim->along[!rim->is_of_column] = -slope / length;
}

/* Every stride-th row and column is searched for the outline, the whole of it. */
static void learn_rims(learn_job *job, const int32_t rect[4], int32_t stride)
{
    for (int32_t y = rect[1] + stride / 2; y < rect[3]; y += stride) {
        for (int32_t x = rect[0]; x < rect[2]; x++) {
            add_rim(job, x, y, 1, 0);
            add_rim(job, x, y, -1, 0);
        }
    }
    for (int32_t x = rect[0] + stride / 2; x < rect[2]; x += stride) {
        for (int32_t y = rect[1]; y < rect[3]; y++) {
            add_rim(job, x, y, 0, 1);
            add_rim(job, x, y, 0, -1);
        }
    }
}

void grab_learn_hand(const grid_query *query, const phys_body *body, phys_grab *grab)
{
    learn_job job = {query, &body->shape, grab,
                     rlf_pose_mul(&query->T_grid_world, &grab->T_world_hand)};
    int32_t rect[4], stride;
    grab->point_count = grab->rim_count = 0;
    if (!grid_footprint(query->grid, job.T_grid_hand.p, body->shape.radius + HAND_M, rect,
                        &stride)) {
        return;
    }
    int32_t wide = rect[2] - rect[0] > rect[3] - rect[1] ? rect[2] - rect[0] : rect[3] - rect[1];
    stride = 1 + wide / SAMPLES_PER_SIDE;
    for (int32_t y = rect[1]; y < rect[3]; y += stride) {
        for (int32_t x = rect[0]; x < rect[2]; x += stride) {
            rlf_vec3 place;
            if (grab->point_count < GRAB_POINTS_MAX && is_of_hand(&job, x, y, &place)) {
                grab->points[grab->point_count++] = place;
            }
        }
    }
    learn_rims(&job, rect, stride);
}
