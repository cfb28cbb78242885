/* What a region's outline in the image says of its motion.
 *
 * Depth shows motion along the normal only: a level tray that slides to the side looks the same.
 * Its outline does not. Where a thing ends before a background that is farther, the outline moves
 * in the image as the thing does, square to itself: the plane through the eye and the outline's
 * tangent touches the thing, and m.v of that plane's normal m is seen. This holds for edges and for
 * the rims of round things alike (Cipolla and Giblin 2000, Visual Motion of Curves and Surfaces).
 *
 * How far it moved is read from the number of the region's pixels in a window about it, now and in
 * the frame before: along an outline that runs slantwise to the pixels these are parts of a pixel.
 */
#include "surface/velocity.h"

#include <math.h>

enum { RADIUS = 3, SIDE = 2 * RADIUS + 1 };

static const float least_step_m = 0.05f; /* to the background: else the outline is but a guess */
static const float least_pull = 0.5f;    /* of a straight outline's: else it is a corner */

static bool is_own(const rlf_flow *job, int32_t label, ptrdiff_t i)
{
    return job->now->label[i] == label;
}

/* Whether pixel k shows what is behind the region's pixel i. */
static bool is_behind(const rlf_flow *job, ptrdiff_t i, ptrdiff_t k)
{
    const rlf_slot *now = job->now;
    return now->foreground[k] == 0 && now->depth[k] > now->depth[i] + least_step_m;
}

static bool is_outline(const rlf_flow *job, int32_t label, ptrdiff_t i)
{
    const ptrdiff_t width = job->stage->grid.width;
    return is_own(job, label, i) && (is_behind(job, i, i - 1) || is_behind(job, i, i + 1) ||
                                     is_behind(job, i, i - width) || is_behind(job, i, i + width));
}

/* The region's pixels in the window about (x, y), and their first moments. */
static int32_t count_window(const rlf_grid *grid, const int32_t *label, int32_t own, int32_t x,
                            int32_t y, int32_t moment[2])
{
    int32_t count = 0, sum_x = 0, sum_y = 0;
    for (int32_t dy = -RADIUS; dy <= RADIUS; dy++) {
        const int32_t *row = label + (ptrdiff_t)(y + dy) * grid->width + x;
        int32_t in_row = 0;
        for (int32_t dx = -RADIUS; dx <= RADIUS; dx++) {
            int32_t is = row[dx] == own;
            in_row += is;
            sum_x += is * dx;
        }
        count += in_row;
        sum_y += in_row * dy;
    }
    moment[0] = sum_x;
    moment[1] = sum_y;
    return count;
}

/* Of a straight outline through the middle of a window: pixels that come in per pixel of motion,
 * and how strongly they pull to one side. */
static bool measure(const rlf_flow *job, int32_t label, int32_t x, int32_t y, rlf_rim *out)
{
    int32_t moment[2];
    out->i = (ptrdiff_t)y * job->stage->grid.width + x;
    out->count = count_window(&job->stage->grid, job->now->label, label, x, y, moment);
    float length = (float)sqrt((double)(moment[0] * moment[0] + moment[1] * moment[1]));
    if (length < least_pull * (float)(SIDE * SIDE * (RADIUS + 1)) / 4.0f) {
        return false;
    }
    out->out_x = -(float)moment[0] / length;
    out->out_y = -(float)moment[1] / length;
    float ax = rlf_kernel_abs(out->out_x), ay = rlf_kernel_abs(out->out_y);
    out->per_pixel = (float)SIDE / (ax > ay ? ax : ay);
    return true;
}

void rlf_rims_find(const rlf_flow *job, const rlf_region *region, rlf_rims *out)
{
    const rlf_grid *grid = &job->stage->grid;
    int32_t step = 1, seen = 0;
    int32_t x0 = region->x0 > RADIUS ? region->x0 : RADIUS;
    int32_t y0 = region->y0 > RADIUS ? region->y0 : RADIUS;
    int32_t x1 = region->x1 < grid->width - RADIUS ? region->x1 : grid->width - RADIUS;
    int32_t y1 = region->y1 < grid->height - RADIUS ? region->y1 : grid->height - RADIUS;
    out->count = 0;
    for (int32_t y = y0; y < y1; y++) {
        for (int32_t x = x0; x < x1; x++) {
            ptrdiff_t i = (ptrdiff_t)y * grid->width + x;
            if (!is_outline(job, region->label, i) || seen++ % step != 0) {
                continue;
            }
            if (out->count == RLF_RIMS_MAX) { /* every second one is enough */
                for (int32_t k = 0; k < RLF_RIMS_MAX / 2; k++) {
                    out->rim[k] = out->rim[2 * k];
                }
                out->count = RLF_RIMS_MAX / 2;
                step *= 2;
            }
            out->count += measure(job, region->label, x, y, &out->rim[out->count]);
        }
    }
}

bool rlf_rim_beyond(const rlf_flow *job, int32_t label, const rlf_rim *rim, rlf_vec3 p, rlf_vec3 v,
                    rlf_vec3 *direction, double *out)
{
    const rlf_grid *grid = &job->stage->grid;
    rlf_vec3 q = rlf_mad(p, v, -(double)job->dt);
    if (!(q.z > 0.01)) {
        return false;
    }
    double du = (q.x / q.z - grid->ray_x[rim->i]) * grid->camera.fx;
    double dv = (q.y / q.z - grid->ray_y[rim->i]) * grid->camera.fy;
    double u = (double)(rim->i % grid->width) + du, w = (double)(rim->i / grid->width) + dv;
    if (!(u >= RADIUS) || !(w >= RADIUS) || !(u < grid->width - RADIUS - 1) ||
        !(w < grid->height - RADIUS - 1)) {
        return false;
    }
    int32_t x = (int32_t)(u + 0.5), y = (int32_t)(w + 0.5), moment[2];
    int32_t before = count_window(grid, job->before->label, label, x, y, moment);
    double part = (u - x) * (double)rim->out_x + (w - y) * (double)rim->out_y;
    double pixels = part - (double)(before - rim->count) / (double)rim->per_pixel;
    rlf_vec3 ray = rlf_normalize(p);
    rlf_vec3 m = rlf_vec3_make(rim->out_x, rim->out_y, 0.0);
    *direction = rlf_normalize(rlf_mad(m, ray, -rlf_dot(m, ray)));
    *out = pixels * p.z / (grid->camera.fx * (double)job->dt);
    return true;
}
