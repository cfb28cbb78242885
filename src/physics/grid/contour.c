/* Outlines: steps in depth and rims of the mask. */
#include "physics/grid/field.h"

#define WINDOW_PX 3

double grid_depth_step(double z)
{
    return 0.03 + 0.02 * z;
}

double grid_contour_end(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
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
    double expected = slope < -GRAZING_COS ? rlf_dot(cell->normal, cell->point) / slope : z;
    if (other > rlf_max(z, expected) + grid_depth_step(z)) {
        return rlf_min(other, z + cell->thickness);
    }
    return 0.0;
}

bool grid_contour_normal(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                         rlf_vec3 *out)
{
    double x = 0.0, y = 0.0;
    for (int32_t dy = -WINDOW_PX; dy <= WINDOW_PX; dy++) {
        for (int32_t dx = -WINDOW_PX; dx <= WINDOW_PX; dx++) {
            if (dx * dx + dy * dy <= WINDOW_PX * WINDOW_PX + 1 &&
                grid_contour_end(grid, sheet, cell, cell->x + dx, cell->y + dy) > 0.0) {
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
        if ((sheet->mask != NULL && sheet->mask[i] == 0) || other > z + grid_depth_step(z)) {
            return k;
        }
        if (other > 0.0 && other < z - grid_depth_step(z)) {
            return limit; /* something stands in front: it goes on behind */
        }
        z = other > 0.0 ? other : z;
    }
    return limit;
}

/* How deep the solid may be as far as its outline tells, `run` pixels along the way from the cell:
 * where the face leans away from there, a deeper one's side would be seen beside it. */
static double depth_beside(const rlf_grid *grid, const rlf_grid_sheet *sheet,
                           const field_cell *cell, const int32_t way[2], int32_t run, double limit)
{
    int32_t x = cell->x + way[0] * run, y = cell->y + way[1] * run, i = y * grid->width + x;
    double z = sheet->depth[i], ray_x = grid->ray_x[i], ray_y = grid->ray_y[i];
    rlf_vec3 end = rlf_vec3_make(z * ray_x, z * ray_y, z), inward = grid_cell_inward(cell);
    double slope = way[0] * (inward.x - ray_x * inward.z) + way[1] * (inward.y - ray_y * inward.z);
    if (slope < GRAZING_COS || sheet->mask != NULL || !(z > 0.0)) {
        return limit;
    }
    /* the last pixels of a run may be the side's */
    double behind = rlf_dot(inward, rlf_sub(end, cell->point)) / rlf_dot(inward, inward);
    double begin = rlf_max(0.0, behind), pixel = z * grid->pixel_angle / slope;
    for (double deep = begin + 0.5 * pixel; deep < limit; deep += pixel) {
        x += way[0];
        y += way[1];
        if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
            return limit;
        }
        double other = sheet->depth[y * grid->width + x];
        if (other > z + (deep - begin) * inward.z + grid_depth_step(z)) {
            return deep;
        }
        if (!(other > z - grid_depth_step(z))) {
            return limit; /* something stands in front, or nothing is known */
        }
    }
    return limit;
}

/* How many of the run's last pixels are on one other face of the solid than the cell: those of what
 * is round are on none, and what has no normal is on no other. */
static int32_t pixels_aside(const rlf_grid *grid, const rlf_grid_sheet *sheet,
                            const field_cell *cell, const int32_t way[2], int32_t run)
{
    rlf_vec3 last = {0, 0, 0};
    int32_t count = 0;
    for (int32_t k = run; k > 0; k--) {
        int32_t i = (cell->y + way[1] * k) * grid->width + cell->x + way[0] * k;
        rlf_vec3 n = rlf_vec3_make(sheet->normal_x[i], sheet->normal_y[i], sheet->normal_z[i]);
        bool is_known = sheet->depth[i] > 0.0f && rlf_dot(n, n) > 0.25;
        if (count == 0 && !is_known) {
            continue;
        }
        last = count == 0 ? n : last;
        if (rlf_dot(n, cell->normal) > SAME_FACE_COS || !(rlf_dot(n, last) > SAME_FACE_COS)) {
            break;
        }
        count++;
    }
    return count;
}

/* How many pixels of a run both ways along the way the solid is wide: its front alone, which is the
 * larger face, and not a side too that is seen beside it. */
static int32_t front_width(const rlf_grid *grid, const rlf_grid_sheet *sheet,
                           const field_cell *cell, const int32_t ways[2][2], const int32_t run[2],
                           int32_t most)
{
    int32_t all = run[0] + 1 + run[1], aside = 0;
    for (int32_t k = 0; k < 2; k++) {
        aside += run[k] < most ? pixels_aside(grid, sheet, cell, ways[k], run[k]) : 0;
    }
    return 2 * aside > all ? aside : all - aside;
}

double grid_guess_depth(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                        double limit)
{
    const int32_t WAYS[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    double pixel = cell->point.z * grid->pixel_angle, deep = limit;
    int32_t most = (int32_t)rlf_min(limit / pixel + 1.0, 256.0), run[4];
    for (int32_t k = 0; k < 4; k++) {
        run[k] = run_length(grid, sheet, cell, WAYS[k], most);
        if (run[k] < most) {
            deep = rlf_min(deep, depth_beside(grid, sheet, cell, WAYS[k], run[k], limit));
        }
    }
    deep = rlf_min(rlf_max(deep, GRID_THIN_M), limit);
    for (int32_t k = 0; k < 4; k += 2) {
        int32_t all = run[k] + 1 + run[k + 1];
        if (0.5 * all * pixel < deep) { /* else the front is wider, whatever is beside it */
            deep = rlf_min(deep, pixel * front_width(grid, sheet, cell, WAYS + k, run + k, most));
        }
    }
    return deep;
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
