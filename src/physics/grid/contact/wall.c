/* Side walls: an outline's pixel stands for the wall of the solid behind it, from front to back. */
#include "physics/grid/ball/ball.h"
#include "physics/grid/contact/search.h"
#include "physics/grid/field.h"

/* A neighbour that is neither missing from the mask nor farther is over no step; see
 * grid_contour_end. */
static bool may_end(const grid_job *job, double z, int32_t x, int32_t y)
{
    const rlf_grid *grid = job->query->grid;
    const rlf_grid_sheet *sheet = job->sheet;
    if (x < 0 || y < 0 || x >= grid->width || y >= grid->height) {
        return false;
    }
    int32_t i = y * grid->width + x;
    return (sheet->mask != NULL && sheet->mask[i] == 0) || (double)sheet->depth[i] > z;
}

static const int32_t NEIGHBOURS[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

/* How far the side wall at this pixel goes inward, metres of thickness, or 0 when it is no outline.
 * Where the solid is a guess it ends where the camera sees through it. */
static double wall_depth(const grid_job *job, const field_cell *cell)
{
    const int32_t STEPS = 4;
    const rlf_grid *grid = job->query->grid;
    const rlf_grid_sheet *sheet = job->sheet;
    double end = 0.0;
    for (int32_t k = 0; k < 4; k++) {
        int32_t x = cell->x + NEIGHBOURS[k][0];
        int32_t y = cell->y + NEIGHBOURS[k][1];
        if (may_end(job, cell->point.z, x, y)) {
            end = rlf_max(end, grid_contour_end(grid, sheet, cell, x, y));
        }
    }
    double deep = rlf_max(0.0, end - cell->point.z);
    if (!(deep > 0.0) || !cell->is_guess) {
        return deep;
    }
    deep = rlf_min(deep, grid_guess_depth(grid, sheet, cell, cell->thickness)); /* nor than wide */
    rlf_vec3 inward = grid_cell_inward(cell);
    for (int32_t k = STEPS; k > 0; k--) {
        double reach = deep * k / STEPS;
        if (!grid_field_is_seen_through(grid, sheet, rlf_mad(cell->point, inward, reach))) {
            return reach;
        }
    }
    return 0.1 * deep; /* an edge still */
}

/* A line of a side wall: from an outline's pixel inward. */
typedef struct wall_line {
    const field_cell *cell;
    rlf_vec3 front, inward; /* now */
    double deep;
    bool is_known, has_side; /* whether the next one was looked for, and found */
    rlf_vec3 side;           /* the outline's direction */
} wall_line;

static rlf_vec3 line_point(const wall_line *line, double depth)
{
    return rlf_mad(line->front, line->inward, depth);
}

static bool find_side(const grid_job *job, wall_line *line)
{
    if (!line->is_known) {
        line->is_known = true;
        line->has_side = grid_contour_normal(job->query->grid, job->sheet, line->cell, &line->side);
    }
    return line->has_side;
}

/* Adds the line's point at `depth` when the body touches it in a direction that is the wall's own
 * up to an angle of cosine `agreement`. */
static void touch_line(grid_job *job, wall_line *line, double depth, double agreement)
{
    rlf_vec3 p = line_point(line, depth), gradient;
    rlf_vec3 local = grid_to_body(job, p);
    double distance = phys_shape_distance(&job->body->shape, local, &gradient);
    rlf_vec3 normal = rlf_neg(rlf_mat3_mul_vec(&job->motion.R_grid_body, gradient));
    double approach = grid_approach_at(job, p, normal, line->cell->velocity);
    if (job->hit_count >= GRID_HITS_MAX / 2 ||
        distance > GRID_MARGIN + rlf_max(0.0, approach) * job->window.horizon) {
        return;
    }
    grid_hit hit = {.point = p, .velocity = line->cell->velocity, .label = line->cell->label};
    hit.anchor = rlf_mad(local, gradient, -distance);
    hit.normal = normal;
    hit.separation = distance;
    if (find_side(job, line)) {
        int32_t edge = depth <= 0.0 ? -1 : depth >= line->deep ? 1 : 0;
        hit.normal = grid_wall_normal(line->inward, line->side, normal, edge);
        rlf_vec3 anchor = rlf_mat3_mul_vec(&job->motion.R_grid_body, hit.anchor);
        hit.separation = rlf_dot(hit.normal, rlf_sub(rlf_add(job->motion.centre, anchor), p));
    }
    if (rlf_dot(hit.normal, normal) > agreement) {
        job->hits[job->hit_count++] = hit;
    }
}

/* How far along `way` from `start` a line comes nearest to the body, whose distance is convex along
 * a line: 0 to `length`, in lengths of `way`, by bisection. */
static double line_nearest(const grid_job *job, rlf_vec3 start, rlf_vec3 way, double length)
{
    const int32_t HALVINGS = 6;
    rlf_vec3 along = rlf_mat3_mul_vec(&job->motion.R_body_grid, way);
    double low = 0.0, high = length, square = rlf_dot(along, along);
    double place = rlf_dot(rlf_sub(job->motion.centre, start), way) / square;
    place = rlf_clamp(place, low, high);
    for (int32_t i = 0; i < HALVINGS; i++) {
        rlf_vec3 gradient, p = rlf_sub(rlf_mad(start, way, place), job->motion.centre);
        phys_shape_distance(&job->body->shape, rlf_mat3_mul_vec(&job->motion.R_body_grid, p),
                            &gradient);
        bool is_beyond = rlf_dot(gradient, along) > 0.0;
        if (is_beyond ? place <= 0.0 : place >= length) {
            return place;
        }
        low = is_beyond ? low : place;
        high = is_beyond ? place : high;
        bool is_first = i == 0; /* it may well be an end */
        place = is_first ? (is_beyond ? low : high) : 0.5 * (low + high);
    }
    return place;
}

static void look_at_contour(grid_job *job, const field_cell *cell, rlf_vec3 shift, double deep)
{
    wall_line line = {.cell = cell, .front = rlf_add(cell->point, shift), .deep = deep};
    line.inward = grid_cell_inward(cell);
    double depth = line_nearest(job, line.front, line.inward, deep);
    double inner = 0.5 * job->body->shape.inner_radius;
    touch_line(job, &line, depth, ASIDE_COS);
    touch_line(job, &line, rlf_max(depth - inner, 0.0), SAME_FACE_COS);
    touch_line(job, &line, rlf_min(depth + inner, line.deep), SAME_FACE_COS);
}

/* Whether the sheet may end on the way from `cell` to the pixel `stride` on, by depths alone: the
 * pixel before an end is no nearer than the nearest so far. */
static bool may_cross_end(const grid_job *job, const field_cell *cell, const int32_t direction[2],
                          int32_t stride)
{
    const rlf_grid *grid = job->query->grid;
    const rlf_grid_sheet *sheet = job->sheet;
    int32_t first = cell->y * grid->width + cell->x, step = direction[1] * grid->width;
    double nearest = cell->point.z, limit = nearest + grid_depth_step(nearest);
    for (int32_t k = 1; k <= stride; k++) {
        int32_t i = first + k * (step + direction[0]);
        double z = sheet->depth[i];
        if ((sheet->mask != NULL && sheet->mask[i] == 0) || z > limit) {
            return true;
        }
        if (z > 0.0 && z < nearest) {
            nearest = z;
            limit = nearest + grid_depth_step(nearest);
        }
    }
    return false;
}

/* The sheet's last pixel from `cell` to the one `stride` on in a direction, beyond which it ends:
 * the wall stands there, not at the pixel that happens to be looked at. False when it goes on. */
static bool find_contour(const grid_job *job, const field_cell *cell, const int32_t direction[2],
                         int32_t stride, field_cell *out)
{
    const rlf_grid *grid = job->query->grid;
    int32_t x = cell->x + direction[0] * stride, y = cell->y + direction[1] * stride;
    if (!may_end(job, cell->point.z, x, y) || !may_cross_end(job, cell, direction, stride)) {
        return false;
    }
    *out = *cell;
    for (int32_t i = 1; i <= stride; i++) {
        x = cell->x + direction[0] * i;
        y = cell->y + direction[1] * i;
        field_cell next;
        if (grid_contour_end(grid, job->sheet, out, x, y) > 0.0) {
            return true;
        }
        if (grid_cell_read(grid, job->sheet, x, y, &next)) {
            *out = next;
        }
    }
    return false;
}

void grid_wall_look(grid_job *job, const field_cell *cell, int32_t stride)
{
    bool is_done = false; /* with the pixel itself */
    /* a side seen at a low angle may be between the pixels that are looked at */
    bool is_face_looked_at = job->is_ball && job->sheet->velocity_x == NULL;
    for (int32_t k = 0; k < 4; k++) {
        field_cell end;
        if (!find_contour(job, cell, NEIGHBOURS[k], stride, &end)) {
            continue;
        }
        bool is_own = end.x == cell->x && end.y == cell->y;
        double deep = is_own && is_done ? 0.0 : wall_depth(job, &end);
        rlf_vec3 shift = rlf_scale(end.velocity, job->query->tau);
        if (is_face_looked_at && !is_own) {
            grid_ball_look(job, &end, rlf_add(end.point, shift));
        }
        if (deep > 0.0 && job->is_ball) {
            grid_ball_look_contour(job, &end, shift, deep);
        } else if (deep > 0.0) {
            look_at_contour(job, &end, shift, deep);
        }
        is_done = is_done || is_own;
    }
}
