/* Outlines: steps in depth and rims of the mask. */
#include "physics/grid/edge.h"

#define WINDOW_PX 3

double grid_edge_step(double z)
{
    return 0.03 + 0.02 * z;
}

double grid_edge_end(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                     int32_t x, int32_t y)
{
    if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
        return 0.0;
    }
    int32_t i = y * grid->width + x;
    double z = cell->point.z;
    if (sheet->mask != NULL && sheet->mask[i] == 0) {
        return z + cell->thickness;
    }
    double other = sheet->depth[i];
    rlf_vec3 ray = rlf_vec3_make(grid->ray_x[i], grid->ray_y[i], 1.0);
    double slope = rlf_dot(cell->normal, ray);
    double expected = slope < -0.02 ? rlf_dot(cell->normal, cell->point) / slope : z;
    if (other > rlf_max(z, expected) + grid_edge_step(z)) {
        return rlf_min(other, z + cell->thickness);
    }
    return 0.0;
}

bool grid_edge_normal(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                      rlf_vec3 *out)
{
    double x = 0.0, y = 0.0;
    for (int32_t dy = -WINDOW_PX; dy <= WINDOW_PX; dy++) {
        for (int32_t dx = -WINDOW_PX; dx <= WINDOW_PX; dx++) {
            if (dx * dx + dy * dy <= WINDOW_PX * WINDOW_PX + 1 &&
                grid_edge_end(grid, sheet, cell, cell->x + dx, cell->y + dy) > 0.0) {
                x += dx;
                y += dy;
            }
        }
    }
    if (x * x + y * y < 1.0) { /* no free pixel, or as many on opposite sides */
        return false;
    }
    rlf_vec3 ray = rlf_normalize(cell->point);
    rlf_vec3 direction = rlf_vec3_make(x, y, 0.0);
    *out = rlf_normalize(rlf_mad(direction, ray, -rlf_dot(direction, ray)));
    return true;
}

/* Pixels from (x, y) along (dx, dy) that belong to the same solid, up to `limit`. */
static int32_t run_length(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                          const int32_t direction[2], int32_t limit)
{
    double z = cell->point.z;
    int32_t x = cell->x, y = cell->y;
    for (int32_t k = 0; k < limit; k++) {
        x += direction[0];
        y += direction[1];
        if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
            return limit; /* who knows how far it goes on out of view */
        }
        int32_t i = y * grid->width + x;
        double other = sheet->depth[i];
        if ((sheet->mask != NULL && sheet->mask[i] == 0) || other > z + grid_edge_step(z)) {
            return k;
        }
        if (other > 0.0 && other < z - grid_edge_step(z)) {
            return limit; /* something stands in front: it goes on behind */
        }
        z = other > 0.0 ? other : z;
    }
    return limit;
}

/* Pixels of the row (axis 0) or column through the cell that belong to its solid; when there are
 * more than `most`, some such number. */
static int32_t line_length(const rlf_grid *grid, const rlf_grid_sheet *sheet,
                           const field_cell *cell, int32_t axis, int32_t most)
{
    const int32_t BACK[2][2] = {{-1, 0}, {0, -1}}, ON[2][2] = {{1, 0}, {0, 1}};
    int32_t back = run_length(grid, sheet, cell, BACK[axis], most);
    return back + 1 + (back < most ? run_length(grid, sheet, cell, ON[axis], most) : 0);
}

double grid_edge_width(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                       double limit)
{
    double pixel = cell->point.z * grid->pixel_angle;
    int32_t most = (int32_t)rlf_min(limit / pixel + 1.0, 256.0);
    int32_t row = line_length(grid, sheet, cell, 0, most);
    int32_t column = line_length(grid, sheet, cell, 1, row < most ? row : most);
    return rlf_min((row < column ? row : column) * pixel, limit);
}

/* The side wall's face, square to the unit axis along which it goes inward. */
static rlf_vec3 wall_face(rlf_vec3 axis, rlf_vec3 side)
{
    rlf_vec3 face = rlf_mad(side, axis, -rlf_dot(side, axis));
    return rlf_dot(face, face) > 0.01 ? rlf_normalize(face) : side;
}

rlf_vec3 grid_wall_along(rlf_vec3 inward, rlf_vec3 side)
{
    rlf_vec3 axis = rlf_normalize(inward);
    return rlf_normalize(rlf_cross(axis, wall_face(axis, side)));
}

rlf_vec3 grid_wall_normal(rlf_vec3 inward, rlf_vec3 side, rlf_vec3 normal, int32_t edge)
{
    rlf_vec3 axis = rlf_normalize(inward), face = wall_face(axis, side);
    double out = rlf_dot(normal, face);
    double along = rlf_dot(normal, axis);
    along = edge < 0 ? rlf_min(along, 0.0) : edge > 0 ? rlf_max(along, 0.0) : 0.0;
    return rlf_normalize(rlf_mad(rlf_scale(axis, along), face, rlf_max(out, 0.0)));
}
