/* A ball's contacts.
 *
 * Every pixel says when the moving ball would reach it; the earliest of each direction is a touch.
 * At the place where the ball is then, the pixels that it all but touches give a plane, each with a
 * weight that falls with its distance: noise averages out, and a curved surface is met where it is
 * nearest. Where that plane ends before the ball's centre is above it, the ball meets an edge, and
 * the contact points from the edge to the centre. */
#include "physics/grid/ball.h"
#include "physics/grid/edge.h"
#include "physics/grid/end.h"

#define EDGE_MOVES 6
#define MOVES 4            /* of the patch to the pixel that is touched first */
#define BEHIND (-0.2)      /* cosine; a face is touched from its own side, up to noise */
#define SAME_DIRECTION 0.9 /* cosine of two touches that are one */

/* Seconds until the ball, `wider` than it is, reaches p, which moves with `velocity`; below 0 for a
 * point that is inside already, the deeper the less. False when that is not before the next query.
 */
static bool time_of_touch(const grid_job *job, rlf_vec3 p, rlf_vec3 velocity, double wider,
                          double *out)
{
    double radius = job->body->shape.shape.radius + wider;
    rlf_vec3 to = rlf_sub(p, job->centre);
    rlf_vec3 w = rlf_sub(job->v, velocity);
    double distance2 = rlf_dot(to, to);
    double near = radius + GRID_MARGIN;
    double a = rlf_dot(w, w), b = rlf_dot(to, w), c = distance2 - radius * radius;
    double square = b * b - a * c;
    bool is_coming = b > 0.0 && c > 0.0 && square >= 0.0;
    double time = is_coming ? c / (b + sqrt(square)) : job->horizon + 1.0;
    if (time > job->horizon && distance2 < near * near) {
        time = rlf_min(0.0, sqrt(distance2) - radius);
    }
    *out = time;
    return time <= job->horizon;
}

/* Between two pixels a face may come this much nearer to the ball than both, metres: pixels are far
 * apart on a face seen at a low angle. It may go on for half a pixel beyond the last one, too. */
static double sag_between(const grid_job *job, const field_cell *cell)
{
    double radius = job->body->shape.shape.radius;
    double cosine = -rlf_dot(cell->normal, cell->point) / rlf_length(cell->point);
    double pitch = job->stride * cell->point.z * job->query->grid->pixel_angle;
    double half = 0.7 * pitch / rlf_max(cosine, 0.1); /* of the diagonal */
    return rlf_min(0.5 * half * half / radius + 0.7 * half, 0.5 * radius);
}

/* Of touches in like directions only the earliest is kept. */
static void note(grid_job *job, const grid_meeting *touch)
{
    int32_t slot = -1;
    for (int32_t i = 0; i < job->meeting_count; i++) {
        if (rlf_dot(job->meetings[i].direction, touch->direction) > SAME_DIRECTION) {
            if (job->meetings[i].time <= touch->time) {
                return;
            }
            slot = i;
        }
    }
    if (slot < 0 && job->meeting_count < GRID_MEETINGS_MAX) {
        slot = job->meeting_count++;
    }
    if (slot >= 0) {
        job->meetings[slot] = *touch;
    }
}

/* Whether the ball's centre is before the cell's front, which is at p now. */
static bool is_before(const grid_job *job, const field_cell *cell, rlf_vec3 p)
{
    return rlf_dot(rlf_sub(job->centre, p), grid_cell_inward(cell)) < 0.0;
}

void grid_ball_look(grid_job *job, const field_cell *seen, rlf_vec3 p)
{
    field_cell cell = *seen;
    grid_meeting touch = {.x = cell.x, .y = cell.y};
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
        if (!time_of_touch(job, point, cell.velocity, sag, &touch.time)) {
            continue;
        }
        rlf_vec3 moved = rlf_mad(point, cell.velocity, rlf_max(0.0, touch.time));
        touch.direction = rlf_normalize(rlf_sub(patch_centre_at(job, touch.time), moved));
        touch.face = is_back ? GRID_TOUCH_BACK : GRID_TOUCH_FRONT;
        double facing = rlf_dot(touch.direction, cell.normal);
        if ((is_back ? -facing : facing) > BEHIND) {
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
    rlf_vec3 seen = rlf_mad(job->centre, tile->velocity, -job->query->tau);
    rlf_vec3 v = rlf_sub(job->v, tile->velocity);
    double closing = -rlf_dot(outward, v);
    double gap = rlf_dot(outward, rlf_sub(seen, p)) - job->body->shape.shape.radius;
    double time = gap > 0.0 && closing > 0.0 ? rlf_min(gap / closing, job->horizon) : 0.0;
    rlf_vec3 foot = rlf_mad(seen, v, time);
    return rlf_mad(foot, outward, -rlf_dot(outward, rlf_sub(foot, p)));
}

void grid_ball_look_tile(grid_job *job, const grid_tile *tile)
{
    rlf_vec3 front = rlf_scale(tile->normal, tile->offset), n = tile->normal;
    rlf_vec3 seen = rlf_mad(job->centre, tile->velocity, -job->query->tau);
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
    return HALF * job->stride * cell->point.z * job->query->grid->pixel_angle /
           rlf_max(across, 0.1);
}

/* From a touched point to the ball's centre, both at the time of the touch. */
static rlf_vec3 way_of(const grid_job *job, const grid_meeting *touch, rlf_vec3 velocity)
{
    rlf_vec3 moved = rlf_mad(touch->point, velocity, rlf_max(0.0, touch->time));
    return rlf_sub(patch_centre_at(job, touch->time), moved);
}

/* Which way the side wall at the outline's pixel pushes the ball. The wall goes on along the
 * outline to where another pixel would be touched first; where none was, it ends, and the ball
 * meets its end. */
static void face_wall(const grid_job *job, const field_cell *cell, rlf_vec3 side, int32_t edge,
                      grid_meeting *touch)
{
    rlf_vec3 inward = grid_cell_inward(cell), along = grid_wall_along(inward, side);
    rlf_vec3 way = way_of(job, touch, cell->velocity);
    double limit = half_way_on(job, cell, along), aside = rlf_dot(way, along), beyond = 0.0;
    double shift = rlf_clamp(aside, -limit, limit);
    touch->point = rlf_mad(touch->point, along, shift);
    way = rlf_mad(way, along, -shift);
    grid_meeting end = *touch; /* its time stays the pixel's: pixels are compared by it */
    if (shift != aside && time_of_touch(job, end.point, cell->velocity, 0.0, &end.time)) {
        way = way_of(job, &end, cell->velocity);
        beyond = rlf_dot(rlf_normalize(way), along);
    }
    rlf_vec3 square = grid_wall_normal(inward, side, rlf_normalize(way), edge);
    touch->direction =
        rlf_mad(rlf_scale(along, beyond), square, sqrt(rlf_max(0.0, 1.0 - beyond * beyond)));
}

void grid_ball_look_outline(grid_job *job, const field_cell *cell, rlf_vec3 shift, double deep)
{
    grid_meeting touch = {.x = cell->x, .y = cell->y, .face = GRID_TOUCH_SIDE};
    rlf_vec3 front = rlf_add(cell->point, shift), centre = job->centre;
    rlf_vec3 inward = grid_cell_inward(cell);
    double share = 0.0;
    for (int32_t i = 0; i < 2; i++) {
        share = rlf_dot(rlf_sub(centre, front), inward) / rlf_dot(inward, inward);
        touch.point = rlf_mad(front, inward, rlf_clamp(share, 0.0, deep));
        if (!time_of_touch(job, touch.point, cell->velocity, 0.0, &touch.time)) {
            return;
        }
        centre =
            rlf_mad(patch_centre_at(job, touch.time), cell->velocity, -rlf_max(0.0, touch.time));
    }
    rlf_vec3 direction = rlf_normalize(way_of(job, &touch, cell->velocity)), side;
    touch.direction = direction;
    if (grid_edge_normal(job->query->grid, job->sheet, cell, &side)) {
        int32_t edge = share <= 0.0 ? -1 : share >= deep ? 1 : 0;
        face_wall(job, cell, side, edge, &touch);
    }
    if (rlf_dot(touch.direction, direction) > 0.3) {
        note(job, &touch);
    }
}

/* Pixels this far apart span the patch that a ball all but touches: radius sqrt(2 r band). */
static int32_t patch_step(const grid_job *job, double z)
{
    double radius = sqrt(2.0 * job->body->shape.shape.radius * patch_band(z));
    return 1 + (int32_t)(radius / (z * job->query->grid->pixel_angle * PATCH_PX));
}

/* Moves the patch to the pixel that the ball reaches first. False when it has none. */
static bool settle(grid_patch *p, const grid_meeting *touch)
{
    const grid_job *job = p->job;
    p->face = touch->face;
    p->x = touch->x;
    p->y = touch->y;
    p->time = touch->time;
    p->step = patch_step(job, rlf_max(0.1, patch_centre_at(job, touch->time).z));
    for (int32_t i = 0; i < MOVES; i++) {
        patch_read(p);
        if (p->nearest < 0) {
            return false;
        }
        const patch_sample *s = &p->samples[p->nearest];
        if (s->cell.x == p->x && s->cell.y == p->y) {
            break;
        }
        p->x = s->cell.x;
        p->y = s->cell.y;
        rlf_vec3 now = rlf_mad(s->point, s->cell.velocity, -rlf_max(0.0, p->time));
        double time;
        if (time_of_touch(job, now, s->cell.velocity, 0.0, &time)) {
            p->time = time;
        }
    }
    return true;
}

/* How far p's pixel lies off the face, metres; false when that is not known. */
static bool height_at(const grid_patch *p, const patch_mean *mean, rlf_vec3 q, double *out,
                      rlf_vec3 *normal)
{
    const rlf_grid *grid = p->job->query->grid;
    const rlf_grid_sheet *sheet = p->job->sheet;
    double tau = p->job->query->tau + rlf_max(0.0, p->time);
    rlf_vec3 seen = rlf_mad(q, mean->velocity, -tau); /* as the pixels show it */
    double u, v;
    if (!(seen.z > 0.0) || !grid->project(grid->project_context, seen, &u, &v) || !(u > -0.5) ||
        !(v > -0.5) || !(u < grid->width - 0.5) || !(v < grid->height - 0.5)) {
        return false;
    }
    int32_t x = (int32_t)(u + 0.5), y = (int32_t)(v + 0.5);
    field_cell cell;
    if (sheet->mask != NULL && sheet->mask[y * grid->width + x] == 0) {
        *out = -1.0; /* free */
        *normal = mean->normal;
        return true;
    }
    if (!grid_cell_read(grid, sheet, x, y, &cell)) {
        return false;
    }
    rlf_vec3 moved = rlf_mad(cell.point, cell.velocity, tau);
    *out = rlf_dot(mean->normal, rlf_sub(moved, mean->point));
    *normal = cell.normal;
    return true;
}

/* Whether the face goes on under the ball's centre. Where something else hides that, or it is not
 * seen, it does for as far as a patch is wide. */
static bool is_supported(const grid_patch *p, const patch_mean *mean)
{
    const double OFF = 0.015, SLIGHT = 0.003;
    double height;
    rlf_vec3 normal;
    rlf_vec3 foot = patch_foot(p, mean);
    if (height_at(p, mean, foot, &height, &normal) && height < OFF) {
        return height > -SLIGHT || (height > -OFF && patch_is_of_face(normal, mean->normal));
    }
    double wide2 = 4.0 * p->job->body->shape.shape.radius * patch_band(foot.z);
    rlf_vec3 d = rlf_sub(foot, p->samples[p->nearest].point);
    return rlf_dot(d, d) < wide2;
}

/* Whether a touch before that one acts in a like direction: a ball has but one contact in each. */
static bool is_known(const grid_job *job, rlf_vec3 normal)
{
    for (int32_t i = 0; i < job->hit_count; i++) {
        if (rlf_dot(job->hits[i].normal, normal) > SAME_DIRECTION) {
            return true;
        }
    }
    return false;
}

/* Adds the plane that was found unless the ball does not come to it before the next query. */
static void add_hit(grid_job *job, double time, const patch_mean *touched, int32_t label)
{
    double radius = job->body->shape.shape.radius;
    double closing = rlf_dot(touched->normal, rlf_sub(touched->velocity, job->v));
    grid_hit hit = {.normal = touched->normal, .velocity = touched->velocity, .label = label};
    hit.rounding = radius;
    hit.point = rlf_mad(touched->point, touched->velocity, -time); /* where it is now */
    hit.separation = rlf_dot(hit.normal, rlf_sub(job->centre, hit.point)) - radius;
    double near = GRID_MARGIN + rlf_max(0.0, closing) * job->horizon;
    if (hit.separation < near && job->hit_count < GRID_HITS_MAX) {
        job->hits[job->hit_count++] = hit;
    }
}

/* When the ball comes to the end of the face, which stands out beyond the pixels that show it, and
 * where on it. */
static rlf_vec3 meet_end(const grid_patch *p, const patch_end *end, const patch_mean *face,
                         double *time)
{
    double start = rlf_max(0.0, p->time);
    rlf_vec3 v = face->velocity, edge = end->point;
    for (int32_t i = 0; i < EDGE_MOVES; i++) {
        double later = rlf_max(0.0, *time) - start;
        rlf_vec3 centre = rlf_mad(patch_centre_at(p->job, *time), v, -later);
        edge = patch_end_nearest(end, centre);
        double next;
        if (!time_of_touch(p->job, rlf_mad(edge, v, -start), v, 0.0, &next)) {
            break;
        }
        *time = next;
    }
    return rlf_mad(edge, v, rlf_max(0.0, *time) - start);
}

/* Reads all pixels about the nearest one. */
static void look_closer(grid_patch *p, const patch_mean *face)
{
    const rlf_grid *grid = p->job->query->grid;
    double tau = p->job->query->tau + rlf_max(0.0, p->time), u, v;
    rlf_vec3 seen = rlf_mad(p->samples[p->nearest].point, face->velocity, -tau);
    if (seen.z > 0.0 && grid->project(grid->project_context, seen, &u, &v)) {
        p->x = (int32_t)rlf_clamp(u + 0.5, 0.0, grid->width - 1.0);
        p->y = (int32_t)rlf_clamp(v + 0.5, 0.0, grid->height - 1.0);
        p->step = 1;
        patch_read(p);
    }
}

/* Which way a back faces is known from a guess's slope: where that is far from the way from the
 * touched point to the ball's centre, the point is no part of such a plane. */
static void face_back(const grid_patch *p, patch_mean *touched)
{
    const double LIKELY = 0.7; /* cosine */
    const patch_sample *nearest = &p->samples[p->nearest];
    rlf_vec3 direction = rlf_normalize(rlf_sub(p->centre, nearest->point));
    touched->normal = grid_back_normal(p->job->query->grid, p->job->sheet, &nearest->cell);
    if (rlf_dot(touched->normal, direction) < LIKELY) {
        touched->normal = direction;
        touched->point = nearest->point;
    }
}

/* The contact points from the edge to the ball's centre. */
static bool face_edge(grid_patch *p, grid_meeting *touch, patch_mean *touched)
{
    patch_end end;
    look_closer(p, touched);
    if (p->nearest < 0) {
        return false;
    }
    bool is_averaged = p->job->sheet->velocity_x == NULL;
    if (is_averaged) {
        patch_find_face(p, touched);
    }
    patch_find_end(p, touched, is_averaged, &end);
    double time = p->time;
    rlf_vec3 edge = meet_end(p, &end, touched, &time);
    touch->time = time;
    rlf_vec3 centre = patch_centre_at(p->job, time), way = rlf_sub(centre, edge);
    rlf_vec3 direction = rlf_normalize(way);
    if (rlf_dot(direction, touched->normal) < BEHIND) {
        return false;
    }
    rlf_vec3 mean = rlf_normalize(rlf_sub(centre, touched->point));
    touched->normal = is_averaged ? direction : rlf_normalize(rlf_add(direction, mean));
    touched->point = rlf_mad(centre, touched->normal, -rlf_length(way));
    return true;
}

static bool touch_face(const grid_job *job, grid_meeting *touch, patch_mean *out, int32_t *label)
{
    grid_patch p = {.job = job};
    if (!settle(&p, touch)) {
        return false;
    }
    const patch_sample *nearest = &p.samples[p.nearest];
    touch->time = p.time;
    *label = nearest->cell.label;
    *out = patch_mean_of(&p);
    if (p.face == GRID_TOUCH_BACK) {
        face_back(&p, out);
    } else if (is_supported(&p, out)) {
        patch_correct_bulge(&p, out);
    } else {
        return face_edge(&p, touch, out);
    }
    return true;
}

static bool touch_wall(const grid_job *job, const grid_meeting *touch, patch_mean *out,
                       int32_t *label)
{
    field_cell cell;
    if (!grid_cell_read(job->query->grid, job->sheet, touch->x, touch->y, &cell)) {
        return false;
    }
    *label = cell.label;
    out->velocity = cell.velocity;
    out->normal = touch->direction;
    out->point = rlf_mad(touch->point, cell.velocity, rlf_max(0.0, touch->time));
    return true;
}

/* A plane that the ball crosses before another touch is one that it never meets: bulges fall away
 * from their planes. */
static bool is_met(const grid_job *job, const patch_mean *touched, double time, double first)
{
    rlf_vec3 point = rlf_mad(touched->point, touched->velocity, first - time);
    double height = rlf_dot(touched->normal, rlf_sub(patch_centre_at(job, first), point));
    return height - job->body->shape.shape.radius > -0.002;
}

void grid_ball_add_hits(grid_job *job)
{
    bool is_used[GRID_MEETINGS_MAX] = {false};
    double first = -1.0;
    for (int32_t k = 0; k < job->meeting_count; k++) {
        int32_t i = -1;
        for (int32_t j = 0; j < job->meeting_count; j++) {
            if (!is_used[j] && (i < 0 || job->meetings[j].time < job->meetings[i].time)) {
                i = j;
            }
        }
        is_used[i] = true;
        grid_meeting touch = job->meetings[i];
        patch_mean touched;
        int32_t label;
        bool is_found = touch.face == GRID_TOUCH_SIDE ? touch_wall(job, &touch, &touched, &label)
                                                      : touch_face(job, &touch, &touched, &label);
        double time = rlf_max(0.0, touch.time);
        if (is_found && (first < 0.0 ||
                         (is_met(job, &touched, time, first) && !is_known(job, touched.normal)))) {
            add_hit(job, time, &touched, label);
            first = first < 0.0 ? time : first;
        }
    }
}
