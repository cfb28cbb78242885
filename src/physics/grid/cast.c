/* The way of a point into the solid, and out of it: through the front, the back or a side. */
#include "physics/grid/cast.h"
#include "physics/grid/field.h"

#define NO_HEIGHT 1e9

/* Whether the cell's back looks at what lies behind, and leaves no room there: the sole of a foot
 * on the floor. Then nothing gets out of the solid that way. */
static bool is_shut(const rlf_grid *grid, const rlf_grid_sheet *sheet, const field_cell *cell)
{
    field_cell behind;
    return sheet == &grid->foreground && grid->background.depth != NULL &&
           grid->background.normal_x != NULL &&
           grid_cell_read(grid, &grid->background, cell->x, cell->y, &behind) &&
           rlf_dot(behind.normal, rlf_sub(grid_back_point(cell), behind.point)) <
               2.0 * GRID_NOISE_M &&
           rlf_dot(behind.normal, grid_back_normal(grid, sheet, cell)) < -APART_COS;
}

/* A point more than half way into a thin solid is no nearer to its own side than to the other. */
static bool looks_back(const field_side *side, rlf_vec3 q, rlf_vec3 direction)
{
    return side->state != FIELD_NONE || !side->has_centre ||
           rlf_dot(direction, rlf_sub(side->centre, q)) > 0.0;
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
    const double LOW = 0.5; /* cosine */
    return rlf_dot(cell->normal, inside->normal) > ONE_FACE_COS &&
           -rlf_dot(cell->normal, rlf_normalize(q)) < LOW;
}

/* Outline of the solid around q, as seen in the image, on the sides that look to the body's centre
 * if it has one: unit direction out of the solid, square to the view ray, and the distance to the
 * free side, metres. False when none is within `radius_px`. */
static bool find_side(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                      const field_side *side, int32_t radius_px, rlf_vec3 *out_normal,
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
        bool is_sought = looks_back(side, q, direction);
        for (int32_t r = 0; is_sought && r <= radius_px && (r - 1) * pixel < best; r++) {
            field_cell cell;
            field_state state = grid_field_at(grid, sheet, rlf_mad(q, direction, r * pixel), &cell);
            is_sought = r == 0 || state == FIELD_INSIDE;
            if (state == FIELD_BEHIND && side->state == FIELD_FRONT &&
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
    if (is_found && last.point.z > 0.0 && grid_contour_normal(grid, sheet, &last, &refined) &&
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
            rlf_dot(near.normal, cell->normal) > ONE_FACE_COS) {
            double off = rlf_dot(cell->normal, rlf_sub(near.point, cell->point));
            if (off < 2.0 * GRID_NOISE_M && off > -2.0 * GRID_NOISE_M) {
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
    set_hit(hit, cell, grid_back_point(cell), grid_back_normal(grid, sheet, cell));
}

/* Through the nearest of front, back and side, or the body's own face and side. */
static void leave_solid(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                        const field_cell *cell, const field_side *side, field_hit *hit)
{
    hit_front(grid, sheet, cell, hit);
    hit->separation = rlf_dot(hit->normal, rlf_sub(q, hit->point));
    if (cell->thickness < FIELD_ENDLESS && side->state != FIELD_FRONT &&
        side->state != FIELD_INSIDE && !is_shut(grid, sheet, cell)) {
        field_hit back;
        hit_back(grid, sheet, cell, &back);
        back.separation = rlf_dot(back.normal, rlf_sub(q, back.point));
        if (side->state == FIELD_BEHIND || back.separation > hit->separation) {
            *hit = back;
        }
    }
    if (hit->separation < -GRID_NOISE_M && side->state != FIELD_INSIDE) {
        double pixel = q.z * grid->pixel_angle;
        int32_t radius = (int32_t)rlf_min(-hit->separation / pixel, 24.0);
        rlf_vec3 normal;
        double distance;
        if (find_side(grid, sheet, q, side, radius, &normal, &distance)) {
            set_hit(hit, cell, rlf_mad(q, normal, distance), normal);
            hit->separation = -distance;
        }
    }
}

/* Whether the solid is between q, behind this face, and the body's centre, before it: the body has
 * sunk into something thin, and belongs before it. */
static bool is_pierced(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                       const field_cell *cell, const field_side *side)
{
    const double DEPTH = 0.5 * GRID_NOISE_M; /* below the face */
    if (side->state != FIELD_FRONT || !side->has_centre) {
        return false;
    }
    double above = rlf_dot(cell->normal, rlf_sub(side->centre, cell->point));
    double below = -rlf_dot(cell->normal, rlf_sub(q, cell->point));
    if (above <= 0.0 || below <= DEPTH) {
        return false;
    }
    double share = (above + DEPTH) / (above + below);
    rlf_vec3 between = rlf_mad(side->centre, rlf_sub(q, side->centre), share);
    field_cell there;
    return grid_field_at(grid, sheet, between, &there) == FIELD_INSIDE &&
           rlf_dot(there.normal, cell->normal) > SAME_FACE_COS;
}

/* The path entered the solid at p: through which face? `step` is the last stretch. */
static void enter_solid(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 p,
                        rlf_vec3 step, field_state from, const field_cell *cell,
                        const field_side *side, field_hit *hit)
{
    field_hit back = {0};
    hit_front(grid, sheet, cell, hit);
    double in_front = -rlf_dot(hit->normal, rlf_sub(p, hit->point));
    double moved = rlf_length(step) + GRID_NOISE_M;
    if (from != FIELD_BEHIND && in_front <= moved) {
        return;
    }
    if (cell->thickness < FIELD_ENDLESS && from != FIELD_FRONT && !is_shut(grid, sheet, cell)) {
        hit_back(grid, sheet, cell, &back);
        if (from == FIELD_BEHIND || -rlf_dot(back.normal, rlf_sub(p, back.point)) <= moved) {
            *hit = back;
            return;
        }
    }
    rlf_vec3 normal;
    double distance;
    if (find_side(grid, sheet, p, side, 4, &normal, &distance)) {
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

bool grid_cast(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q, rlf_vec3 path,
               double margin, const field_side *side, field_hit *out)
{
    field_cell cell;
    bool is_before = grid_field_is_well_before(grid, sheet, q, 2.0 * margin);
    field_state state = is_before ? FIELD_FRONT : grid_field_at(grid, sheet, q, &cell);
    if (state == FIELD_INSIDE || (state == FIELD_BEHIND && side->state == FIELD_INSIDE)) {
        leave_solid(grid, sheet, q, &cell, side, out);
        return true;
    }
    if (state == FIELD_FRONT && !is_before &&
        rlf_dot(cell.normal, rlf_sub(q, cell.point)) < 2.0 * margin) {
        hit_front(grid, sheet, &cell, out);
        out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
        if (out->separation < margin) {
            return true;
        }
    } else if (state == FIELD_BEHIND && is_pierced(grid, sheet, q, &cell, side)) {
        hit_front(grid, sheet, &cell, out);
        out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
        return true;
    } else if (state == FIELD_BEHIND && q.z - cell.back < 4.0 * margin &&
               !is_shut(grid, sheet, &cell)) {
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
        if (state != FIELD_BEHIND && grid_field_is_well_before(grid, sheet, p, -NO_HEIGHT)) {
            state = FIELD_FRONT;
            continue;
        }
        field_state next = grid_field_at(grid, sheet, p, &cell);
        if (next == FIELD_INSIDE || is_through(&cell, state, next, p.z - step.z)) {
            enter_solid(grid, sheet, p, step, state, &cell, side, out);
            out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
            return true;
        }
        state = next;
    }
    return false;
}
