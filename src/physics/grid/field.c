/* Reading one sheet of the grid: where a point stands to the solid. */
#include "physics/grid/field.h"

/* What is not below these is no measurement, m and m/s. */
#define FARTHEST 1e6
#define FASTEST 1e3
/* A sheet is taken to be at least this thick, so that a point cannot sit on both its sides. */
#define THICKNESS_MIN GRID_NOISE_M
/* Missing pixels are bridged from neighbours up to this many pixels away. */
#define BRIDGE_PX 2
/* A point this far before what is seen on its ray is in free space: noise and slanted pixels, m. */
#define SEEN_BEHIND (3.0 * GRID_NOISE_M)
/* The plane of a pixel is taken to be nowhere nearer than this share of its depth. */
#define NEAREST_SHARE 0.95
/* Farther behind a back it matters to nobody how far, metres. */
#define FAR_BEHIND GRID_THIN_M

/* All three planes, or none of them. */
static bool are_all_or_none(const float *x, const float *y, const float *z)
{
    return (x == NULL) == (y == NULL) && (y == NULL) == (z == NULL);
}

static bool is_sheet_whole(const rlf_grid_sheet *sheet)
{
    return are_all_or_none(sheet->normal_x, sheet->normal_y, sheet->normal_z) &&
           are_all_or_none(sheet->velocity_x, sheet->velocity_y, sheet->velocity_z);
}

bool grid_is_whole(const rlf_grid *grid)
{
    return grid->width > 0 && grid->height > 0 && grid->ray_x != NULL && grid->ray_y != NULL &&
           grid->project != NULL && is_sheet_whole(&grid->background) &&
           is_sheet_whole(&grid->foreground);
}

bool grid_cell_read(const rlf_grid *grid, const rlf_grid_sheet *sheet, int32_t x, int32_t y,
                    field_cell *out)
{
    if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
        return false;
    }
    int32_t i = y * grid->width + x;
    if (sheet->mask != NULL && sheet->mask[i] == 0) {
        return false;
    }
    double z = sheet->depth[i];
    rlf_vec3 n = rlf_vec3_make(sheet->normal_x[i], sheet->normal_y[i], sheet->normal_z[i]);
    if (!(z > 0.0 && z < FARTHEST) || !(rlf_dot(n, n) > 0.25 && rlf_dot(n, n) < 4.0)) {
        return false;
    }
    out->x = x;
    out->y = y;
    out->label = sheet->label != NULL ? sheet->label[i] : 0;
    out->point = rlf_vec3_make(z * grid->ray_x[i], z * grid->ray_y[i], z);
    out->normal = n;
    out->velocity = rlf_vec3_make(0, 0, 0);
    if (sheet->velocity_x != NULL) {
        out->velocity =
            rlf_vec3_make(sheet->velocity_x[i], sheet->velocity_y[i], sheet->velocity_z[i]);
        if (!(rlf_dot(out->velocity, out->velocity) < FASTEST * FASTEST)) {
            out->velocity = rlf_vec3_make(0, 0, 0);
        }
    }
    double known = sheet->thickness != NULL ? sheet->thickness[i] : 0.0;
    double thickness = known > 0.0 ? known : sheet->default_thickness;
    bool is_endless = sheet->thickness == NULL && !(thickness > 0.0);
    bool is_thick = thickness > THICKNESS_MIN && thickness < FARTHEST;
    out->thickness = is_endless ? FIELD_ENDLESS : is_thick ? thickness : THICKNESS_MIN;
    out->is_guess = !(known > 0.0) && thickness > 0.0;
    return true;
}

static bool is_masked_out(const rlf_grid *grid, const rlf_grid_sheet *sheet, int32_t x, int32_t y)
{
    return sheet->mask != NULL && sheet->mask[y * grid->width + x] == 0;
}

/* The pixel at (x, y) or, across a small hole, the nearest one that has a surface. */
static bool read_bridged(const rlf_grid *grid, const rlf_grid_sheet *sheet, int32_t x, int32_t y,
                         field_cell *out)
{
    if (grid_cell_read(grid, sheet, x, y, out)) {
        return true;
    }
    if (is_masked_out(grid, sheet, x, y)) {
        return false;
    }
    for (int32_t r = 1; r <= BRIDGE_PX; r++) {
        for (int32_t dy = -r; dy <= r; dy++) {
            int32_t step = dy == -r || dy == r ? 1 : 2 * r;
            for (int32_t dx = -r; dx <= r; dx += step) {
                if (grid_cell_read(grid, sheet, x + dx, y + dy, out)) {
                    return true;
                }
            }
        }
    }
    return false;
}

bool grid_pixel_of(const rlf_grid *grid, rlf_vec3 q, int32_t *x, int32_t *y)
{
    double u, v;
    if (!(q.z > 0.0) || !grid->project(grid->project_context, q, &u, &v) || !(u > -0.5) ||
        !(v > -0.5) || !(u < grid->width - 0.5) || !(v < grid->height - 0.5)) {
        return false;
    }
    *x = (int32_t)(u + 0.5);
    *y = (int32_t)(v + 0.5);
    return true;
}

/* Depth of the pixel's plane on the ray of q: pixels are wide on slanted surfaces. */
static double plane_depth(const field_cell *cell, rlf_vec3 q)
{
    double slope = rlf_dot(cell->normal, q) / q.z;
    double z = cell->point.z;
    if (slope > -GRAZING_COS) {
        return z;
    }
    double on_ray = rlf_dot(cell->normal, cell->point) / slope;
    return rlf_clamp(on_ray, NEAREST_SHARE * z, 1.05 * z);
}

bool grid_field_is_open(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q)
{
    int32_t x, y;
    if (!grid_pixel_of(grid, q, &x, &y) || is_masked_out(grid, sheet, x, y)) {
        return false;
    }
    double z = sheet->depth[y * grid->width + x];
    return z < FARTHEST && q.z < NEAREST_SHARE * z;
}

bool grid_field_is_seen_through(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q)
{
    int32_t x, y;
    field_cell cell;
    return grid_pixel_of(grid, q, &x, &y) && grid_cell_read(grid, sheet, x, y, &cell) &&
           plane_depth(&cell, q) > q.z + SEEN_BEHIND;
}

bool grid_field_may_hide(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q)
{
    int32_t x, y;
    return grid_pixel_of(grid, q, &x, &y) && !(sheet->depth[y * grid->width + x] > q.z);
}

bool grid_field_is_well_before(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                               double height)
{
    int32_t x, y;
    if (!grid_pixel_of(grid, q, &x, &y)) {
        return false;
    }
    int32_t i = y * grid->width + x;
    double z = sheet->depth[i];
    field_cell cell = {.point = {z * grid->ray_x[i], z * grid->ray_y[i], z}};
    cell.normal = rlf_vec3_make(sheet->normal_x[i], sheet->normal_y[i], sheet->normal_z[i]);
    double size2 = rlf_dot(cell.normal, cell.normal);
    return (sheet->mask == NULL || sheet->mask[i] != 0) && z > 0.0 && z < FARTHEST &&
           size2 > 0.25 && size2 < 4.0 && q.z < plane_depth(&cell, q) &&
           !(rlf_dot(cell.normal, rlf_sub(q, cell.point)) < height);
}

/* Whether q, behind the cell's plane, is beside what is seen of that face. */
static bool is_beside(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                      rlf_vec3 q)
{
    double height = rlf_dot(cell->normal, rlf_sub(q, cell->point));
    return grid_field_is_seen_through(grid, sheet, rlf_mad(q, cell->normal, -height));
}

/* How thick a guess is takes a walk over its pixels: where q's state does not hang on that, only
 * `is_whole` asks for it. */
static inline field_state state_at(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                                   bool is_whole, field_cell *out)
{
    int32_t x, y;
    if (!grid_pixel_of(grid, q, &x, &y) || !read_bridged(grid, sheet, x, y, out)) {
        return FIELD_NONE;
    }
    double front = plane_depth(out, q);
    out->back = front + out->thickness;
    if (q.z < front) {
        return FIELD_FRONT;
    }
    if (q.z > out->back + FAR_BEHIND) {
        return FIELD_BEHIND; /* whatever its width */
    }
    if (out->is_guess) {
        bool is_told = q.z <= front + THICKNESS_MIN || q.z > out->back;
        if (is_whole || !is_told) {
            /* How thick it is was never seen: no thicker than it is wide (a table's leg). */
            out->thickness = grid_guess_depth(grid, sheet, out, out->thickness);
            out->thickness = rlf_max(out->thickness, THICKNESS_MIN);
            out->back = front + out->thickness;
        }
        if (q.z <= out->back && is_beside(grid, sheet, out, q)) {
            return FIELD_BEHIND;
        }
    }
    return q.z <= out->back ? FIELD_INSIDE : FIELD_BEHIND;
}

field_state grid_field_at(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                          field_cell *out)
{
    return state_at(grid, sheet, q, true, out);
}

field_state grid_field_state(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                             field_cell *out)
{
    return state_at(grid, sheet, q, false, out);
}

rlf_vec3 grid_back_point(const field_cell *cell)
{
    return rlf_mad(cell->point, grid_cell_inward(cell), cell->thickness);
}

/* Back point of the neighbour at (x, y). False across a step. */
static bool read_back(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                      const int32_t offset[2], rlf_vec3 *out)
{
    field_cell near;
    int32_t x = cell->x + offset[0], y = cell->y + offset[1];
    if (!grid_cell_read(grid, sheet, x, y, &near) ||
        grid_contour_end(grid, sheet, cell, x, y) > 0.0 ||
        grid_contour_end(grid, sheet, &near, cell->x, cell->y) > 0.0) {
        return false;
    }
    *out = grid_back_point(&near);
    return true;
}

rlf_vec3 grid_back_normal(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell)
{
    const int32_t OFFSETS[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    rlf_vec3 p[4];
    if (cell->is_guess) {
        return rlf_neg(cell->normal);
    }
    for (int32_t k = 0; k < 4; k++) {
        if (!read_back(grid, sheet, cell, OFFSETS[k], &p[k])) {
            return rlf_neg(cell->normal);
        }
    }
    rlf_vec3 n = rlf_normalize(rlf_cross(rlf_sub(p[1], p[0]), rlf_sub(p[3], p[2])));
    if (!(rlf_dot(n, n) > 0.5)) {
        return rlf_neg(cell->normal);
    }
    return rlf_dot(n, cell->point) < 0.0 ? rlf_neg(n) : n;
}
