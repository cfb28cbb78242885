/* Extending a sheet's border. */
#include "physics/grid_border.h"

#define RING_PX 32  /* how far inwards the first pixel that has a surface may be */
#define INSET_PX 4  /* border pixels are the noisiest: look this much farther in */
#define WINDOW_PX 6 /* the plane is the mean of every second pixel up to this far */

static bool in_view(const rlf_grid *grid, double ray_x, double ray_y, double *u, double *v)
{
    return grid->project(grid->project_context, rlf_vec3_make(ray_x, ray_y, 1.0), u, v) &&
           *u > -0.5 && *v > -0.5 && *u < grid->width - 0.5 && *v < grid->height - 0.5;
}

/* Where the way from `inside` (in view) to `outside` leaves the image; a lens may be distorted, so
 * by bisection. Rays are x and y at z = 1. */
static void leave_view(const rlf_grid *grid, const double inside[2], const double outside[2],
                       double out[2])
{
    double low = 0.0, high = 1.0; /* share of the way: in view, out of view */
    double u, v;
    for (int32_t i = 0; i < 12; i++) {
        double t = 0.5 * (low + high);
        bool is_in = in_view(grid, inside[0] + t * (outside[0] - inside[0]),
                             inside[1] + t * (outside[1] - inside[1]), &u, &v);
        low = is_in ? t : low;
        high = is_in ? high : t;
    }
    out[0] = inside[0] + low * (outside[0] - inside[0]);
    out[1] = inside[1] + low * (outside[1] - inside[1]);
}

/* Pixel of the border nearest to q: on q's own row or column where it has one, else the corner. */
static bool border_pixel(const rlf_grid *grid, rlf_vec3 q, int32_t pixel[2])
{
    int32_t middle = grid->height / 2 * grid->width + grid->width / 2;
    const double centre[2] = {grid->ray_x[middle], grid->ray_y[middle]};
    double ray[2] = {q.x / q.z, q.y / q.z};
    double u, v;
    if (!in_view(grid, ray[0], ray[1], &u, &v)) {
        double inside[2] = {centre[0], ray[1]};
        double column[2] = {ray[0], centre[1]};
        if (in_view(grid, column[0], column[1], &u, &v)) {
            leave_view(grid, column, ray, ray);
        } else {
            if (!in_view(grid, inside[0], inside[1], &u, &v)) {
                leave_view(grid, centre, inside, inside);
            }
            const double level[2] = {ray[0], inside[1]};
            leave_view(grid, inside, level, ray);
        }
        if (!in_view(grid, ray[0], ray[1], &u, &v)) {
            return false;
        }
    }
    pixel[0] = (int32_t)(u + 0.5);
    pixel[1] = (int32_t)(v + 0.5);
    return true;
}

/* Steps inwards: a unit along each axis on which the pixel is near the image's border. */
static bool inward(const rlf_grid *grid, const int32_t pixel[2], int32_t step[2])
{
    const int32_t size[2] = {grid->width, grid->height};
    for (int32_t k = 0; k < 2; k++) {
        step[k] = (pixel[k] < RING_PX) - (pixel[k] >= size[k] - RING_PX);
    }
    return step[0] != 0 || step[1] != 0;
}

static void fit(const rlf_grid *grid, const rlf_grid_sheet *sheet, field_cell *cell)
{
    rlf_vec3 points = {0, 0, 0}, normals = {0, 0, 0};
    double count = 0.0;
    for (int32_t dy = -WINDOW_PX; dy <= WINDOW_PX; dy += 2) {
        for (int32_t dx = -WINDOW_PX; dx <= WINDOW_PX; dx += 2) {
            field_cell near;
            if (!grid_cell_read(grid, sheet, cell->x + dx, cell->y + dy, &near)) {
                continue;
            }
            double off = rlf_dot(cell->normal, rlf_sub(near.point, cell->point));
            if (rlf_dot(near.normal, cell->normal) > 0.95 && off < 0.03 && off > -0.03) {
                points = rlf_add(points, near.point);
                normals = rlf_add(normals, near.normal);
                count += 1.0;
            }
        }
    }
    cell->point = rlf_scale(points, 1.0 / count); /* the cell itself is one of them */
    cell->normal = rlf_normalize(normals);
}

bool grid_border_read(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                      field_cell *out)
{
    int32_t pixel[2], step[2];
    if (!(q.z > 0.05) || !border_pixel(grid, q, pixel) || !inward(grid, pixel, step)) {
        return false;
    }
    int32_t last = RING_PX;
    bool is_found = false;
    for (int32_t k = 0; k <= last; k++) {
        field_cell cell;
        if (grid_cell_read(grid, sheet, pixel[0] + k * step[0], pixel[1] + k * step[1], &cell)) {
            last = is_found ? last : k + INSET_PX;
            *out = cell;
            is_found = true;
        }
    }
    if (is_found) {
        fit(grid, sheet, out);
        out->is_extended = true;
    }
    return is_found;
}
