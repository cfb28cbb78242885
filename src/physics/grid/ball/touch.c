/* A ball's touches: every pixel says when the moving ball would reach it; the earliest of each
 * direction is one. */
#include "physics/grid/ball/ball.h"
#include "physics/grid/field.h"

bool grid_ball_time(const grid_job *job, rlf_vec3 p, rlf_vec3 velocity, double wider, double *out)
{
    double radius = job->body->shape.shape.radius + wider;
    rlf_vec3 to = rlf_sub(p, job->motion.centre);
    rlf_vec3 w = rlf_sub(job->motion.v, velocity);
    double distance2 = rlf_dot(to, to);
    double near = radius + GRID_MARGIN;
    double a = rlf_dot(w, w), b = rlf_dot(to, w), c = distance2 - radius * radius;
    double square = b * b - a * c;
    bool is_coming = b > 0.0 && c > 0.0 && square >= 0.0;
    double time = is_coming ? c / (b + sqrt(square)) : job->window.horizon + 1.0;
    if (time > job->window.horizon && distance2 < near * near) {
        time = rlf_min(0.0, sqrt(distance2) - radius);
    }
    *out = time;
    return time <= job->window.horizon;
}

/* Between two pixels a face may come this much nearer to the ball than both, metres: pixels are far
 * apart on a face seen at a low angle. It may go on for half a pixel beyond the last one, too. */
static double sag_between(const grid_job *job, const field_cell *cell)
{
    double radius = job->body->shape.shape.radius;
    double half = grid_cell_half(job->query->grid, cell, job->scan.stride);
    return rlf_min(0.5 * half * half / radius, half) + 0.7 * half;
}

/* Of touches in like directions only the earliest is kept. */
static void note(grid_job *job, const grid_touch *touch)
{
    int32_t slot = -1;
    for (int32_t i = 0; i < job->touch_count; i++) {
        if (rlf_dot(job->touches[i].direction, touch->direction) > SAME_FACE_COS) {
            if (job->touches[i].time <= touch->time) {
                return;
            }
            slot = i;
        }
    }
    if (slot < 0 && job->touch_count < GRID_TOUCHES_MAX) {
        slot = job->touch_count++;
    }
    if (slot >= 0) {
        job->touches[slot] = *touch;
    }
}

/* Whether the ball's centre is before the cell's front, which is at p now. */
static bool is_before(const grid_job *job, const field_cell *cell, rlf_vec3 p)
{
    return rlf_dot(rlf_sub(job->motion.centre, p), grid_cell_inward(cell)) < 0.0;
}

bool grid_ball_may_meet_back(const field_cell *cell, rlf_vec3 p, rlf_vec3 direction)
{
    return !cell->is_guess || rlf_dot(direction, p) >= 0.0;
}

void grid_ball_look(grid_job *job, const field_cell *seen, rlf_vec3 p)
{
    field_cell cell = *seen;
    grid_touch touch = {.x = cell.x, .y = cell.y};
    double sag = sag_between(job, seen);
    for (int32_t side = 0; side < 2; side++) {
        bool is_back = side == 1;
        if (is_back && (cell.thickness >= FIELD_ENDLESS || is_before(job, &cell, p))) {
            return;
        }
        if (is_back) {
            patch_limit_thickness(job, &cell);
        }
        rlf_vec3 point = is_back ? patch_back_of(&cell, p) : p;
        if (is_back && cell.is_guess &&
            grid_field_is_seen_through(job->query->grid, job->sheet, point)) {
            return;
        }
        if (!grid_ball_time(job, point, cell.velocity, sag, &touch.time)) {
            continue;
        }
        rlf_vec3 moved = rlf_mad(point, cell.velocity, rlf_max(0.0, touch.time));
        touch.direction = rlf_normalize(rlf_sub(patch_centre_at(job, touch.time), moved));
        if (is_back && !grid_ball_may_meet_back(&cell, moved, touch.direction)) {
            return;
        }
        touch.face = is_back ? GRID_TOUCH_BACK : GRID_TOUCH_FRONT;
        double facing = rlf_dot(touch.direction, cell.normal);
        if ((is_back ? -facing : facing) > GRID_BALL_BEHIND) {
            note(job, &touch);
        }
    }
}

/* The tile's pixel that shows p; the nearest one where p is beside the tile. */
static void pixel_in_tile(const grid_job *job, const grid_tile *tile, rlf_vec3 p, int32_t at[2])
{
    const rlf_grid *grid = job->query->grid;
    int32_t size = job->tiles->size, index = (int32_t)(tile - job->tiles->tiles);
    int32_t x0 = index % job->tiles->columns * size, y0 = index / job->tiles->columns * size;
    double u, v;
    if (!(p.z > 0.0) || !grid->project(grid->project_context, p, &u, &v)) {
        u = x0 + 0.5 * size;
        v = y0 + 0.5 * size;
    }
    at[0] = (int32_t)rlf_clamp(u + 0.5, x0, rlf_min(x0 + size, grid->width) - 1.0);
    at[1] = (int32_t)rlf_clamp(v + 0.5, y0, rlf_min(y0 + size, grid->height) - 1.0);
}

/* The pixel that shows p or, where it has no depth, a neighbour towards the tile's middle. */
static bool read_in_tile(const grid_job *job, const grid_tile *tile, rlf_vec3 p, field_cell *out)
{
    int32_t half = job->tiles->size / 2, at[2];
    pixel_in_tile(job, tile, p, at);
    for (int32_t k = 0; k < 4; k++) {
        if (grid_cell_read(job->query->grid, job->sheet, at[0], at[1], out)) {
            return true;
        }
        at[0] += at[0] % (2 * half) < half ? 1 : -1;
        at[1] += at[1] % (2 * half) < half ? 1 : -1;
    }
    return false;
}

/* The place under the ball's centre, as the sheet sees it, on the plane through p at the time when
 * the ball comes to it; `outward` points to the ball. */
static rlf_vec3 foot_on(const grid_job *job, const grid_tile *tile, rlf_vec3 outward, rlf_vec3 p)
{
    rlf_vec3 seen = rlf_mad(job->motion.centre, tile->velocity, -job->query->tau);
    rlf_vec3 v = rlf_sub(job->motion.v, tile->velocity);
    double closing = -rlf_dot(outward, v);
    double gap = rlf_dot(outward, rlf_sub(seen, p)) - job->body->shape.shape.radius;
    double time = gap > 0.0 && closing > 0.0 ? rlf_min(gap / closing, job->window.horizon) : 0.0;
    rlf_vec3 foot = rlf_mad(seen, v, time);
    return rlf_mad(foot, outward, -rlf_dot(outward, rlf_sub(foot, p)));
}

void grid_ball_look_tile(grid_job *job, const grid_tile *tile)
{
    rlf_vec3 front = rlf_scale(tile->normal, tile->offset), n = tile->normal;
    rlf_vec3 seen = rlf_mad(job->motion.centre, tile->velocity, -job->query->tau);
    field_cell cell;
    if (read_in_tile(job, tile, foot_on(job, tile, n, front), &cell)) {
        grid_ball_look(job, &cell, rlf_mad(cell.point, cell.velocity, job->query->tau));
    }
    if (rlf_dot(n, seen) > tile->offset || !read_in_tile(job, tile, seen, &cell) ||
        cell.thickness >= FIELD_ENDLESS) {
        return;
    }
    /* another pixel shows the face before the place where the ball comes to the back */
    rlf_vec3 back = foot_on(job, tile, rlf_neg(n), patch_back_of(&cell, cell.point));
    if (read_in_tile(job, tile, back, &cell)) {
        grid_ball_look(job, &cell, rlf_mad(cell.point, cell.velocity, job->query->tau));
    }
}

/* How far the next pixel of an outline is that is looked at, half way, metres along it. */
static double half_way_on(const grid_job *job, const field_cell *cell, rlf_vec3 along)
{
    const double HALF = 0.75; /* ... and a part of one: pixels are where they are */
    rlf_vec3 ray = rlf_scale(cell->point, 1.0 / cell->point.z);
    double across = rlf_length(rlf_mad(along, ray, -along.z)); /* of the view */
    return HALF * job->scan.stride * cell->point.z * job->query->grid->pixel_angle /
           rlf_max(across, 0.1);
}

/* From a touched point to the ball's centre, both at the time of the touch. */
static rlf_vec3 way_of(const grid_job *job, const grid_touch *touch, rlf_vec3 velocity)
{
    rlf_vec3 moved = rlf_mad(touch->point, velocity, rlf_max(0.0, touch->time));
    return rlf_sub(patch_centre_at(job, touch->time), moved);
}

/* Which way the side wall at the outline's pixel pushes the ball. The wall goes on along the
 * outline to where another pixel would be touched first; where none was, it ends, and the ball
 * meets its end. */
static void face_wall(const grid_job *job, const field_cell *cell, rlf_vec3 side, int32_t edge,
                      grid_touch *touch)
{
    rlf_vec3 inward = grid_cell_inward(cell), along = grid_wall_along(inward, side);
    rlf_vec3 way = way_of(job, touch, cell->velocity);
    double limit = half_way_on(job, cell, along), aside = rlf_dot(way, along), beyond = 0.0;
    double shift = rlf_clamp(aside, -limit, limit);
    touch->point = rlf_mad(touch->point, along, shift);
    way = rlf_mad(way, along, -shift);
    grid_touch end = *touch; /* its time stays the pixel's: pixels are compared by it */
    if (shift != aside && grid_ball_time(job, end.point, cell->velocity, 0.0, &end.time)) {
        way = way_of(job, &end, cell->velocity);
        beyond = rlf_dot(rlf_normalize(way), along);
    }
    rlf_vec3 square = grid_wall_normal(inward, side, rlf_normalize(way), edge);
    touch->direction =
        rlf_mad(rlf_scale(along, beyond), square, sqrt(rlf_max(0.0, 1.0 - beyond * beyond)));
}

void grid_ball_look_contour(grid_job *job, const field_cell *cell, rlf_vec3 shift, double deep)
{
    grid_touch touch = {.x = cell->x, .y = cell->y, .face = GRID_TOUCH_SIDE};
    rlf_vec3 front = rlf_add(cell->point, shift), centre = job->motion.centre;
    rlf_vec3 inward = grid_cell_inward(cell);
    double share = 0.0;
    for (int32_t i = 0; i < 2; i++) {
        share = rlf_dot(rlf_sub(centre, front), inward) / rlf_dot(inward, inward);
        touch.point = rlf_mad(front, inward, rlf_clamp(share, 0.0, deep));
        if (!grid_ball_time(job, touch.point, cell->velocity, 0.0, &touch.time)) {
            return;
        }
        centre =
            rlf_mad(patch_centre_at(job, touch.time), cell->velocity, -rlf_max(0.0, touch.time));
    }
    rlf_vec3 direction = rlf_normalize(way_of(job, &touch, cell->velocity)), side;
    touch.direction = direction;
    if (grid_contour_normal(job->query->grid, job->sheet, cell, &side)) {
        int32_t edge = share <= 0.0 ? -1 : share >= deep ? 1 : 0;
        face_wall(job, cell, side, edge, &touch);
    }
    if (rlf_dot(touch.direction, direction) > ASIDE_COS) {
        note(job, &touch);
    }
}
