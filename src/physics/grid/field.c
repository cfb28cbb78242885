/* Reading one sheet of the grid: front, back and side of the solid at a point. */
#include "physics/grid/field.h"
#include "physics/grid/edge.h"

/* What is not below these is no measurement, m and m/s. */
#define FARTHEST 1e6
#define FASTEST 1e3
/* A sheet is taken to be at least this thick, so that a point cannot sit on both its sides. */
#define THICKNESS_MIN 0.01
/* Missing pixels are bridged from neighbours up to this many pixels away. */
#define BRIDGE_PX 2
/* A point this far before what is seen on its ray is in free space: noise and slanted pixels, m. */
#define SEEN_BEHIND 0.03
#define NO_HEIGHT 1e9
/* The plane of a pixel is taken to be nowhere nearer than this share of its depth. */
#define NEAREST_SHARE 0.95
/* Farther behind a back it matters to nobody how far, metres. */
#define FAR_BEHIND 0.05

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

static bool pixel_of(const rlf_grid *grid, rlf_vec3 q, int32_t *x, int32_t *y)
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
    if (slope > -0.02) {
        return z;
    }
    double on_ray = rlf_dot(cell->normal, cell->point) / slope;
    return rlf_clamp(on_ray, NEAREST_SHARE * z, 1.05 * z);
}

rlf_vec3 grid_cell_inward(const field_cell *cell)
{
    double facing = rlf_dot(cell->normal, cell->point) / cell->point.z;
    if (!cell->is_guess || facing > -0.02) {
        return rlf_scale(cell->point, 1.0 / cell->point.z);
    }
    return rlf_scale(cell->normal, facing);
}

bool grid_field_is_open(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q)
{
    int32_t x, y;
    if (!pixel_of(grid, q, &x, &y) || is_masked_out(grid, sheet, x, y)) {
        return false;
    }
    double z = sheet->depth[y * grid->width + x];
    return z < FARTHEST && q.z < NEAREST_SHARE * z;
}

bool grid_field_is_seen_through(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q)
{
    int32_t x, y;
    field_cell cell;
    return pixel_of(grid, q, &x, &y) && grid_cell_read(grid, sheet, x, y, &cell) &&
           plane_depth(&cell, q) > q.z + SEEN_BEHIND;
}

/* Whether q, behind the cell's plane, is beside what is seen of that face. */
static bool is_beside(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                      rlf_vec3 q)
{
    double height = rlf_dot(cell->normal, rlf_sub(q, cell->point));
    return grid_field_is_seen_through(grid, sheet, rlf_mad(q, cell->normal, -height));
}

field_state grid_field_at(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                          field_cell *out)
{
    int32_t x, y;
    if (!pixel_of(grid, q, &x, &y) || !read_bridged(grid, sheet, x, y, out)) {
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
        /* How thick it is was never seen: no thicker than it is wide (a table's leg). */
        out->thickness = grid_edge_width(grid, sheet, out, out->thickness);
        out->thickness = rlf_max(out->thickness, THICKNESS_MIN);
        out->back = front + out->thickness;
        if (q.z <= out->back && is_beside(grid, sheet, out, q)) {
            return FIELD_BEHIND;
        }
    }
    return q.z <= out->back ? FIELD_INSIDE : FIELD_BEHIND;
}

static rlf_vec3 back_point(const field_cell *cell)
{
    return rlf_mad(cell->point, grid_cell_inward(cell), cell->thickness);
}

/* Back point of the neighbour at (x, y). False across a step. */
static bool read_back(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                      const int32_t offset[2], rlf_vec3 *out)
{
    field_cell near;
    int32_t x = cell->x + offset[0], y = cell->y + offset[1];
    if (!grid_cell_read(grid, sheet, x, y, &near) || grid_edge_end(grid, sheet, cell, x, y) > 0.0 ||
        grid_edge_end(grid, sheet, &near, cell->x, cell->y) > 0.0) {
        return false;
    }
    *out = back_point(&near);
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

/* A point more than half way into a thin solid is no nearer to its own side than to the other. */
static bool looks_home(const field_home *home, rlf_vec3 q, rlf_vec3 direction)
{
    return home->side != FIELD_NONE || !home->has_centre ||
           rlf_dot(direction, rlf_sub(home->centre, q)) > 0.0;
}

/* How far from q the solid ends between `inside` and `outside`, metres along `direction`: to a
 * fraction of a pixel. */
static double end_between(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                          rlf_vec3 direction, double inside, double outside)
{
    const int32_t HALVINGS = 4;
    for (int32_t i = 0; i < HALVINGS; i++) {
        field_cell cell;
        double middle = 0.5 * (inside + outside);
        bool is_in =
            grid_field_at(grid, sheet, rlf_mad(q, direction, middle), &cell) == FIELD_INSIDE;
        inside = is_in ? middle : inside;
        outside = is_in ? outside : middle;
    }
    return 0.5 * (inside + outside);
}

/* Whether a pixel goes on with the face of the last one inside it, which is seen at a low angle:
 * there its solid, along the ray, is thin. */
static bool is_one_slanted_face(const field_cell *cell, const field_cell *inside, rlf_vec3 q)
{
    const double SAME = 0.95, LOW = 0.5; /* cosines */
    return rlf_dot(cell->normal, inside->normal) > SAME &&
           -rlf_dot(cell->normal, rlf_normalize(q)) < LOW;
}

bool grid_field_side(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                     const field_home *home, int32_t radius_px, rlf_vec3 *out_normal,
                     double *out_distance)
{
    double pixel = q.z * grid->pixel_angle;
    double best = (radius_px + 0.5) * pixel;
    field_cell last = {0};
    bool is_found = false;
    for (int32_t k = 0; k < 8; k++) {
        double angle = k * (RLF_PI / 4.0);
        rlf_vec3 direction = rlf_vec3_make(rlf_cos(angle), rlf_sin(angle), 0.0);
        field_cell inside = {0};
        bool is_sought = looks_home(home, q, direction);
        for (int32_t r = 0; is_sought && r <= radius_px && (r - 1) * pixel < best; r++) {
            field_cell cell;
            field_state state = grid_field_at(grid, sheet, rlf_mad(q, direction, r * pixel), &cell);
            is_sought = r == 0 || state == FIELD_INSIDE;
            if (state == FIELD_BEHIND && home->side == FIELD_FRONT &&
                is_one_slanted_face(&cell, &inside, q)) {
                break; /* the solid ends there, but not the face */
            }
            inside = state == FIELD_INSIDE ? cell : inside;
            double end = best;
            if (!is_sought) {
                end = end_between(grid, sheet, q, direction, (r - 1) * pixel, r * pixel);
            }
            if (end < best) {
                best = end;
                last = inside;
                rlf_vec3 ray = rlf_normalize(q);
                *out_normal = rlf_normalize(rlf_mad(direction, ray, -rlf_dot(direction, ray)));
                *out_distance = best;
                is_found = true;
            }
        }
    }
    rlf_vec3 refined; /* eight directions are coarse; the outline itself knows better */
    if (is_found && last.point.z > 0.0 && grid_edge_normal(grid, sheet, &last, &refined) &&
        rlf_dot(refined, *out_normal) > 0.5) {
        *out_distance *= rlf_dot(refined, *out_normal);
        *out_normal = refined;
    }
    return is_found;
}

static void set_hit(field_hit *hit, const field_cell *cell, rlf_vec3 point, rlf_vec3 normal)
{
    hit->point = point;
    hit->normal = normal;
    hit->velocity = cell->velocity;
    hit->label = cell->label;
}

/* Plane through the pixel's like-minded 3x3 neighbours: one pixel's noise counts a third. */
static void hit_front(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                      field_hit *hit)
{
    rlf_vec3 points = {0, 0, 0}, normals = {0, 0, 0};
    double count = 0.0;
    for (int32_t i = 0; i < 9; i++) {
        field_cell near;
        if (grid_cell_read(grid, sheet, cell->x + i % 3 - 1, cell->y + i / 3 - 1, &near) &&
            rlf_dot(near.normal, cell->normal) > 0.95) {
            double off = rlf_dot(cell->normal, rlf_sub(near.point, cell->point));
            if (off < 0.02 && off > -0.02) {
                points = rlf_add(points, near.point);
                normals = rlf_add(normals, near.normal);
                count += 1.0;
            }
        }
    }
    set_hit(hit, cell, rlf_scale(points, 1.0 / count), rlf_normalize(normals));
}

static void hit_back(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell,
                     field_hit *hit)
{
    set_hit(hit, cell, back_point(cell), grid_back_normal(grid, sheet, cell));
}

/* Through the nearest of front, back and side, or the home's face and side. */
static void leave_solid(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                        const field_cell *cell, const field_home *home, field_hit *hit)
{
    hit_front(grid, sheet, cell, hit);
    hit->separation = rlf_dot(hit->normal, rlf_sub(q, hit->point));
    if (cell->thickness < FIELD_ENDLESS && home->side != FIELD_FRONT &&
        home->side != FIELD_INSIDE) {
        field_hit back;
        hit_back(grid, sheet, cell, &back);
        back.separation = rlf_dot(back.normal, rlf_sub(q, back.point));
        if (home->side == FIELD_BEHIND || back.separation > hit->separation) {
            *hit = back;
        }
    }
    const double SHALLOW = 0.01;
    if (hit->separation < -SHALLOW && home->side != FIELD_INSIDE) {
        double pixel = q.z * grid->pixel_angle;
        int32_t radius = (int32_t)rlf_min(-hit->separation / pixel, 24.0);
        rlf_vec3 normal;
        double distance;
        if (grid_field_side(grid, sheet, q, home, radius, &normal, &distance)) {
            set_hit(hit, cell, rlf_mad(q, normal, distance), normal);
            hit->separation = -distance;
        }
    }
}

/* Whether the solid is between q, behind this face, and the body's centre, before it: the body has
 * sunk into something thin, and belongs before it. */
static bool is_pierced(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                       const field_cell *cell, const field_home *home)
{
    const double DEPTH = 0.005, SAME = 0.9; /* m below the face; cosine */
    if (home->side != FIELD_FRONT || !home->has_centre) {
        return false;
    }
    double above = rlf_dot(cell->normal, rlf_sub(home->centre, cell->point));
    double below = -rlf_dot(cell->normal, rlf_sub(q, cell->point));
    if (above <= 0.0 || below <= DEPTH) {
        return false;
    }
    double share = (above + DEPTH) / (above + below);
    rlf_vec3 between = rlf_mad(home->centre, rlf_sub(q, home->centre), share);
    field_cell there;
    return grid_field_at(grid, sheet, between, &there) == FIELD_INSIDE &&
           rlf_dot(there.normal, cell->normal) > SAME;
}

/* The path entered the solid at p: through which face? `step` is the last stretch. */
static void enter_solid(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 p,
                        rlf_vec3 step, field_state from, const field_cell *cell,
                        const field_home *home, field_hit *hit)
{
    const double SLACK = 0.01;
    field_hit back = {0};
    hit_front(grid, sheet, cell, hit);
    double in_front = -rlf_dot(hit->normal, rlf_sub(p, hit->point));
    double moved = rlf_length(step) + SLACK;
    if (from != FIELD_BEHIND && in_front <= moved) {
        return;
    }
    if (cell->thickness < FIELD_ENDLESS && from != FIELD_FRONT) {
        hit_back(grid, sheet, cell, &back);
        if (from == FIELD_BEHIND || -rlf_dot(back.normal, rlf_sub(p, back.point)) <= moved) {
            *hit = back;
            return;
        }
    }
    rlf_vec3 normal;
    double distance;
    if (grid_field_side(grid, sheet, p, home, 4, &normal, &distance)) {
        set_hit(hit, cell, rlf_mad(p, normal, distance), normal);
    }
}

/* The last stretch, from depth z_before, jumped over this pixel's whole solid. Passing from in
 * front of one pixel to behind its neighbour does not: that is how a body flies behind a table's
 * leg. */
static bool is_through(const field_cell *cell, field_state before, field_state now, double z_before)
{
    return (before == FIELD_FRONT && now == FIELD_BEHIND &&
            z_before < cell->back - cell->thickness) ||
           (before == FIELD_BEHIND && now == FIELD_FRONT && z_before > cell->back);
}

/* Whether q is before the pixel on its ray, higher than `height` over its plane: most of what is
 * asked about is, and the pixel's depth and normal tell it. */
static bool is_well_before(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                           double height)
{
    int32_t x, y;
    if (!pixel_of(grid, q, &x, &y)) {
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

bool grid_field_cast(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q, rlf_vec3 path,
                     double margin, const field_home *home, field_hit *out)
{
    field_cell cell;
    bool is_before = is_well_before(grid, sheet, q, 2.0 * margin);
    field_state state = is_before ? FIELD_FRONT : grid_field_at(grid, sheet, q, &cell);
    if (state == FIELD_INSIDE || (state == FIELD_BEHIND && home->side == FIELD_INSIDE)) {
        leave_solid(grid, sheet, q, &cell, home, out);
        return true;
    }
    if (state == FIELD_FRONT && !is_before &&
        rlf_dot(cell.normal, rlf_sub(q, cell.point)) < 2.0 * margin) {
        hit_front(grid, sheet, &cell, out);
        out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
        if (out->separation < margin) {
            return true;
        }
    } else if (state == FIELD_BEHIND && is_pierced(grid, sheet, q, &cell, home)) {
        hit_front(grid, sheet, &cell, out);
        out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
        return true;
    } else if (state == FIELD_BEHIND && q.z - cell.back < 4.0 * margin) {
        hit_back(grid, sheet, &cell, out);
        out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
        if (out->separation < margin) {
            return true;
        }
    }
    double pixels = rlf_length(path) / rlf_max(q.z * grid->pixel_angle, 1e-4);
    int32_t steps = (int32_t)rlf_clamp(pixels + 1.0, 1.0, 64.0);
    rlf_vec3 step = rlf_scale(path, 1.0 / steps);
    for (int32_t k = 1; k <= steps; k++) {
        rlf_vec3 p = rlf_mad(q, step, k);
        if (state != FIELD_BEHIND && is_well_before(grid, sheet, p, -NO_HEIGHT)) {
            state = FIELD_FRONT;
            continue;
        }
        field_state next = grid_field_at(grid, sheet, p, &cell);
        if (next == FIELD_INSIDE || is_through(&cell, state, next, p.z - step.z)) {
            enter_solid(grid, sheet, p, step, state, &cell, home, out);
            out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
            return true;
        }
        state = next;
    }
    return false;
}
