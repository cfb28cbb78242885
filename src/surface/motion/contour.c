/* What a region's contour in the image says of its motion.
 *
 * Depth shows motion along the normal only: a level tray that slides to the side looks the same.
 * Its contour does not. Where a thing ends before a background that is farther, the contour moves
 * in the image as the thing does, square to itself: the plane through the eye and the contour's
 * tangent touches the thing, and m.v of that plane's normal m is seen. This holds for edges and for
 * those of round things alike (Cipolla and Giblin 2000, Visual Motion of Curves and Surfaces).
 *
 * How far it moved is read from the number of the region's pixels in a window about it, now and in
 * the frame before: along a contour that runs slantwise to the pixels these are parts of a pixel.
 */
#include "surface/motion/motion.h"
#include "surface/window.h"

#include <math.h>

enum {
    RADIUS = RLF_CONTOUR_RADIUS,
    SIDE = RLF_CONTOUR_SIDE,
    FIRST_STEP = 2 /* along the contour: the windows of two neighbours are almost the same */
};

static const float least_pull = 0.5f; /* of a straight contour's: else it is a corner */

/* Of a straight contour through the middle of a window: pixels that come in per pixel of motion,
 * and how strongly they pull to one side. */
static bool measure(const rlf_flow *job, int32_t label, int32_t x, int32_t y,
                    rlf_contour_point *out)
{
    int32_t window[3], width = job->stage->grid.width;
    rlf_kernel_contour_window(job->now->label, width, label, x, y, window);
    out->i = (ptrdiff_t)y * width + x;
    out->count = window[0];
    out->before_x = out->before_y = -1;
    float length = (float)sqrt((double)(window[1] * window[1] + window[2] * window[2]));
    if (length < least_pull * (float)(SIDE * SIDE * (RADIUS + 1)) / 4.0f) {
        return false;
    }
    out->out_x = -(float)window[1] / length;
    out->out_y = -(float)window[2] / length;
    float ax = rlf_kernel_abs(out->out_x), ay = rlf_kernel_abs(out->out_y);
    out->per_pixel = (float)SIDE / (ax > ay ? ax : ay);
    return true;
}

/* Takes every step-th of the region's contour; twice that step where they become too many. */
static void add_contour_point(const rlf_flow *job, int32_t label, int32_t x, int32_t y,
                              rlf_contour *out)
{
    if (out->seen++ % out->step != 0) {
        return;
    }
    if (out->count == RLF_CONTOUR_MAX) { /* every second one is enough */
        for (int32_t k = 0; k < RLF_CONTOUR_MAX / 2; k++) {
            out->point[k] = out->point[2 * k];
        }
        out->count = RLF_CONTOUR_MAX / 2;
        out->step *= 2;
    }
    out->count += measure(job, label, x, y, &out->point[out->count]);
}

/* Pixels of the span that a window fits about. */
static rlf_span inside(const image_grid *grid, rlf_span span)
{
    return (rlf_span){span.x0 > RADIUS ? span.x0 : RADIUS,
                      rlf_least(span.x1, grid->width - RADIUS)};
}

/* Pixels of the rows that windows fit about, beside the background, of all regions at once. */
static void mark_rows(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    const rlf_flow *job = context;
    int32_t width = job->stage->grid.width;
    for (int32_t y = begin + RADIUS; y < end + RADIUS; y++) {
        rlf_span span = inside(&job->stage->grid, job->now->moved[y]);
        ptrdiff_t i = (ptrdiff_t)y * width + span.x0;
        const rlf_kernel_contour_in row = {job->now->foreground + i, job->now->depth + i, width,
                                           rlf_flow_limb_m};
        if (span.x0 < span.x1) {
            rlf_kernel_contour_row(&row, span.x1 - span.x0, job->stage->velocity.is_contour + i);
        }
    }
}

void rlf_contour_mark(const rlf_flow *job)
{
    rlf_flow copy = *job;
    const image_grid *grid = &job->stage->grid;
    if (grid->width > SIDE && grid->height > SIDE) {
        rlf_parallel_for(job->stage->def.pool, grid->height - 2 * RADIUS, RLF_ROW_GRAIN, mark_rows,
                         &copy);
    }
}

/* What the region's motion is found from is far apart in memory: brought near, before windows and
 * pixels ask for it. */
RLF_KERNEL_PART void fetch_row(const rlf_flow *job, ptrdiff_t row, rlf_span span)
{
    enum { LINE = 16 }; /* values of a line of cache */
    for (int32_t x = span.x0; x < span.x1 + LINE - 1; x += LINE) {
        ptrdiff_t i = row + rlf_least(x, span.x1 - 1);
        RLF_KERNEL_SOON(&job->before->label[i]);
        RLF_KERNEL_SOON(&job->view.seen[i]);
        for (int k = 0; k < 3; k++) {
            RLF_KERNEL_SOON(&job->now->normal[k][i]);
        }
    }
}

void rlf_contour_find(const rlf_flow *job, const rlf_region *region, rlf_contour *out)
{
    const image_grid *grid = &job->stage->grid;
    rlf_span span = inside(grid, (rlf_span){region->x0, region->x1});
    int32_t y0 = region->y0 > RADIUS ? region->y0 : RADIUS;
    int32_t y1 = region->y1 < grid->height - RADIUS ? region->y1 : grid->height - RADIUS;
    out->count = out->seen = 0;
    out->step = FIRST_STEP;
    if (grid->width <= SIDE) {
        return; /* too narrow for a window */
    }
    for (int32_t y = y0; y < y1; y++) {
        ptrdiff_t row = (ptrdiff_t)y * grid->width;
        const uint8_t *is_contour = job->stage->velocity.is_contour + row;
        const int32_t *label = job->now->label + row;
        fetch_row(job, row, span);
        for (int32_t x = span.x0; (x = rlf_kernel_next_mark(is_contour, x, span.x1)) < span.x1;
             x++) {
            if (label[x] == region->label) {
                add_contour_point(job, region->label, x, y, out);
            }
        }
    }
}

/* The region's pixels in the window about (x, y) a frame ago. Passes that improve a motion ask for
 * the same place again. */
static int32_t count_before(const rlf_flow *job, int32_t label, int32_t x, int32_t y,
                            rlf_contour_point *point)
{
    if (point->before_x != x || point->before_y != y) {
        int32_t window[3];
        rlf_kernel_contour_window(job->before->label, job->stage->grid.width, label, x, y, window);
        point->before_x = x;
        point->before_y = y;
        point->before_count = window[0];
    }
    return point->before_count;
}

bool rlf_contour_beyond(const rlf_flow *job, int32_t label, rlf_contour_point *point, rlf_vec3 p,
                        rlf_vec3 v, double *out)
{
    const image_grid *grid = &job->stage->grid;
    rlf_vec3 q = rlf_mad(p, v, -(double)job->dt);
    if (!(q.z > 0.0)) {
        return false;
    }
    double du = (q.x / q.z - grid->ray_x[point->i]) * grid->camera.fx;
    double dv = (q.y / q.z - grid->ray_y[point->i]) * grid->camera.fy;
    double u = (double)(point->i % grid->width) + du, w = (double)(point->i / grid->width) + dv;
    if (!(u >= RADIUS) || !(w >= RADIUS) || !(u < grid->width - RADIUS - 1) ||
        !(w < grid->height - RADIUS - 1)) {
        return false;
    }
    int32_t x = (int32_t)(u + 0.5), y = (int32_t)(w + 0.5);
    int32_t before = count_before(job, label, x, y, point);
    double part = (u - x) * (double)point->out_x + (w - y) * (double)point->out_y;
    double pixels = part - (double)(before - point->count) / (double)point->per_pixel;
    *out = pixels * p.z / (grid->camera.fx * (double)job->dt);
    return true;
}

rlf_vec3 rlf_contour_direction(const rlf_contour_point *point, rlf_vec3 p)
{
    rlf_vec3 ray = rlf_normalize(p);
    rlf_vec3 m = rlf_vec3_make(point->out_x, point->out_y, 0.0);
    return rlf_normalize(rlf_mad(m, ray, -rlf_dot(m, ray)));
}
