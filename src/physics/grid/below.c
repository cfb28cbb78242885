/* Lifting bodies from below the picture, and what they may touch there. */
#include "physics/grid/below.h"

#define HIGHEST 0.25  /* m that a place is lifted until it is in view */
#define UPRIGHT 0.3   /* sine of the angle between a side and the vertical */
#define SAME_FOOT 0.1 /* m beside a touch that its foot may be */
#define BESIDE_PX 1   /* an outline's place is that far off */

static bool pixel_of(const rlf_grid *grid, rlf_vec3 q, int32_t *x, int32_t *y)
{
    double u, v;
    if (!(q.z > 0.0) || !grid->project(grid->project_context, q, &u, &v)) {
        return false;
    }
    *x = (int32_t)(u + 0.5);
    *y = (int32_t)(v + 0.5);
    return true;
}

double grid_below_rise(const grid_query *query, rlf_vec3 q, double radius)
{
    const rlf_grid *grid = query->grid;
    int32_t x, y;
    bool has_up = rlf_dot(query->up, query->up) > 0.0;
    if (query->shell == NULL || !has_up || !(q.z > 0.0) || pixel_of(grid, q, &x, &y) ||
        !pixel_of(grid, rlf_mad(q, query->up, HIGHEST), &x, &y)) {
        return 0.0;
    }
    double pixel = rlf_max(q.z * grid->pixel_angle, 0.002);
    for (double rise = pixel; rise < HIGHEST; rise += pixel) {
        field_cell cell;
        if (pixel_of(grid, rlf_mad(q, query->up, rise), &x, &y) &&
            grid_cell_read(grid, &grid->background, x, y, &cell)) {
            return rise + radius;
        }
    }
    return 0.0;
}

static bool is_upright(const grid_query *query, rlf_vec3 normal)
{
    double slope = rlf_dot(normal, query->up);
    return slope < UPRIGHT && slope > -UPRIGHT;
}

/* The lowest pixel of a column that shows anything; false when none does from row y on. */
static bool read_lowest(const rlf_grid *grid, int32_t x, int32_t y, field_cell *out)
{
    for (int32_t row = grid->height - 1; row >= y; row--) {
        if (grid_cell_read(grid, &grid->background, x, row, out)) {
            return true;
        }
    }
    return false;
}

bool grid_below_stands(const grid_query *query, const grid_hit *hit)
{
    const rlf_grid *grid = query->grid;
    int32_t x, y;
    if (!is_upright(query, hit->normal) || !pixel_of(grid, hit->point, &x, &y)) {
        return false;
    }
    for (int32_t k = -BESIDE_PX; k <= BESIDE_PX; k++) {
        field_cell foot;
        if (!read_lowest(grid, x + k, y, &foot) || !is_upright(query, foot.normal)) {
            continue;
        }
        rlf_vec3 off = rlf_sub(foot.point, hit->point);
        off = rlf_mad(off, query->up, -rlf_dot(off, query->up));
        if (rlf_dot(off, off) < SAME_FOOT * SAME_FOOT) {
            return true;
        }
    }
    return false;
}
