/* A ball's contacts.
 *
 * Every pixel says when the moving ball would reach it; the earliest of each direction is a touch.
 * At the place where the ball is then, the pixels that it all but touches give a plane, each with a
 * weight that falls with its distance: noise averages out, and a curved surface is met where it is
 * nearest. Where that plane ends before the ball's centre is above it, the ball meets an edge, and
 * the contact points from the edge to the centre. */
#include "physics/grid_ball.h"
#include "physics/grid_edge.h"
#include "physics/grid_patch.h"

#define EDGE_MOVES 2
#define MOVES 4            /* of the patch to the pixel that is touched first */
#define BEHIND (-0.2)      /* cosine; a face is touched from its own side, up to noise */
#define SAME_DIRECTION 0.9 /* cosine of two touches that are one */

/* Distance beyond the nearest pixel's at which a pixel's weight has fallen to 0: some sigma. */
static double band_at(double z)
{
    return 0.003 + 0.0005 * z * z;
}

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

static rlf_vec3 centre_at(const grid_job *job, double time)
{
    return rlf_mad(job->centre, job->v, rlf_max(0.0, time));
}

/* How thick a background is was never seen: no thicker than wide (a table's leg). */
static void limit_thickness(const grid_job *job, field_cell *cell)
{
    if (job->sheet->thickness == NULL) {
        cell->thickness = grid_edge_width(job->query->grid, job->sheet, cell, cell->thickness);
    }
}

static rlf_vec3 back_of(const grid_job *job, const field_cell *cell, rlf_vec3 p)
{
    return rlf_mad(p, grid_cell_inward(job->sheet, cell), cell->thickness);
}

/* Whether the ball's centre is before the cell's front, which is at p now. */
static bool is_before(const grid_job *job, const field_cell *cell, rlf_vec3 p)
{
    return rlf_dot(rlf_sub(job->centre, p), grid_cell_inward(job->sheet, cell)) < 0.0;
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
            limit_thickness(job, &cell);
        }
        rlf_vec3 point = is_back ? back_of(job, &cell, p) : p;
        if (is_back && job->sheet->thickness == NULL &&
            grid_field_is_seen_through(job->query->grid, job->sheet, point)) {
            return;
        }
        if (!time_of_touch(job, point, cell.velocity, sag, &touch.time)) {
            continue;
        }
        rlf_vec3 moved = rlf_mad(point, cell.velocity, rlf_max(0.0, touch.time));
        touch.direction = rlf_normalize(rlf_sub(centre_at(job, touch.time), moved));
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
    rlf_vec3 back = foot_on(job, tile, rlf_neg(n), back_of(job, &cell, cell.point));
    if (read_in_tile(job, tile, back, &cell)) {
        grid_ball_look(job, &cell, rlf_mad(cell.point, cell.velocity, job->query->tau));
    }
}

void grid_ball_look_outline(grid_job *job, const field_cell *cell, rlf_vec3 shift, double deep)
{
    grid_meeting touch = {.x = cell->x, .y = cell->y, .face = GRID_TOUCH_SIDE};
    rlf_vec3 front = rlf_add(cell->point, shift), centre = job->centre;
    rlf_vec3 inward = grid_cell_inward(job->sheet, cell);
    double share = 0.0;
    for (int32_t i = 0; i < 2; i++) {
        share = rlf_dot(rlf_sub(centre, front), inward) / rlf_dot(inward, inward);
        touch.point = rlf_mad(front, inward, rlf_clamp(share, 0.0, deep));
        if (!time_of_touch(job, touch.point, cell->velocity, 0.0, &touch.time)) {
            return;
        }
        centre = rlf_mad(centre_at(job, touch.time), cell->velocity, -rlf_max(0.0, touch.time));
    }
    rlf_vec3 moved = rlf_mad(touch.point, cell->velocity, rlf_max(0.0, touch.time));
    rlf_vec3 direction = rlf_normalize(rlf_sub(centre_at(job, touch.time), moved));
    rlf_vec3 side;
    touch.direction = direction;
    if (grid_edge_normal(job->query->grid, job->sheet, cell, &side)) {
        int32_t edge = share <= 0.0 ? -1 : share >= deep ? 1 : 0;
        touch.direction = grid_wall_normal(inward, side, direction, edge);
    }
    if (rlf_dot(touch.direction, direction) > 0.3) {
        note(job, &touch);
    }
}

static void read_patch(grid_patch *p)
{
    const grid_job *job = p->job;
    double tau = job->query->tau + rlf_max(0.0, p->time);
    p->centre = centre_at(job, p->time);
    p->count = 0;
    int32_t *index = p->index;
    p->nearest = -1;
    for (int32_t dy = -PATCH_PX; dy <= PATCH_PX; dy++) {
        for (int32_t dx = -PATCH_PX; dx <= PATCH_PX; dx++) {
            patch_sample *s = &p->samples[p->count];
            *index = 0;
            index++;
            if (!grid_cell_read(job->query->grid, job->sheet, p->x + dx * p->step,
                                p->y + dy * p->step, &s->cell)) {
                continue;
            }
            s->point = rlf_mad(s->cell.point, s->cell.velocity, tau);
            if (p->face == GRID_TOUCH_BACK) {
                limit_thickness(job, &s->cell);
                s->point = back_of(job, &s->cell, s->point);
            }
            s->distance = rlf_length(rlf_sub(p->centre, s->point)) - job->body->shape.shape.radius;
            if (p->nearest < 0 || s->distance < p->samples[p->nearest].distance) {
                p->nearest = p->count;
            }
            p->count++;
            index[-1] = p->count;
        }
    }
}

/* Pixels this far apart span the patch that a ball all but touches: radius sqrt(2 r band). */
static int32_t patch_step(const grid_job *job, double z)
{
    double radius = sqrt(2.0 * job->body->shape.shape.radius * band_at(z));
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
    p->step = patch_step(job, rlf_max(0.1, centre_at(job, touch->time).z));
    for (int32_t i = 0; i < MOVES; i++) {
        read_patch(p);
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

/* As much surface as the pixel shows, in pixels seen head-on at 1 m. */
static double area_of(const field_cell *cell)
{
    double cosine = -rlf_dot(cell->normal, cell->point) / rlf_length(cell->point);
    return cell->point.z * cell->point.z / rlf_max(cosine, 0.15);
}

/* Weighted means over the pixels near the ball, and the slope of the normals over the points (least
 * squares for n - n_mean = curvature (p - p_mean)). */
static patch_mean mean_of(const grid_patch *p)
{
    double least = p->samples[p->nearest].distance;
    double band = band_at(p->samples[p->nearest].cell.point.z);
    rlf_vec3 points = {0, 0, 0}, normals = {0, 0, 0}, velocities = {0, 0, 0};
    rlf_vec3 face = p->samples[p->nearest].cell.normal;
    double total = 0.0, square = 0.0, product = 0.0;
    rlf_vec3 origin = p->samples[p->nearest].point; /* small differences, few digits lost */
    for (int32_t i = 0; i < p->count; i++) {
        const patch_sample *s = &p->samples[i];
        double share = 1.0 - (s->distance - least) / band;
        if (share <= 0.0 || !patch_is_of_face(s->cell.normal, face)) {
            continue;
        }
        double weight = share * share * area_of(&s->cell);
        rlf_vec3 d = rlf_sub(s->point, origin);
        points = rlf_mad(points, d, weight);
        normals = rlf_mad(normals, s->cell.normal, weight);
        velocities = rlf_mad(velocities, s->cell.velocity, weight);
        square += weight * rlf_dot(d, d);
        product += weight * rlf_dot(d, s->cell.normal);
        total += weight;
    }
    rlf_vec3 d = rlf_scale(points, 1.0 / total);
    rlf_vec3 n = rlf_scale(normals, 1.0 / total);
    patch_mean mean = {.point = rlf_add(origin, d), .normal = rlf_normalize(n)};
    mean.velocity = rlf_scale(velocities, 1.0 / total);
    mean.spread2 = rlf_max(0.0, square / total - rlf_dot(d, d));
    if (mean.spread2 > 1e-7) {
        mean.curvature = rlf_max(0.0, (product / total - rlf_dot(d, n)) / mean.spread2);
    }
    return mean;
}

/* A patch that lies off the touching point by d has a normal that is off by curvature d one way,
 * and a direction to the ball's centre that is off by d / radius the other way: together they are
 * right. The touching point stands above the mean of a bulge. */
static void correct_bulge(const grid_patch *p, patch_mean *mean)
{
    double radius = p->job->body->shape.shape.radius;
    rlf_vec3 direction = rlf_normalize(rlf_sub(p->centre, mean->point));
    mean->normal = rlf_normalize(rlf_mad(mean->normal, direction, radius * mean->curvature));
    mean->point = rlf_mad(mean->point, mean->normal, 0.5 * mean->curvature * mean->spread2);
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
    double wide2 = 4.0 * p->job->body->shape.shape.radius * band_at(foot.z);
    rlf_vec3 d = rlf_sub(foot, p->samples[p->nearest].point);
    return rlf_dot(d, d) < wide2;
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

/* The edge stands out beyond the pixels that show the face, so that the ball comes to it before
 * them, at another place. Returns where it is then. */
static rlf_vec3 meet_edge(grid_patch *p, const patch_mean *face)
{
    const rlf_vec3 v = face->velocity;
    double start = rlf_max(0.0, p->time);
    rlf_vec3 now = rlf_mad(patch_edge(p, face), v, -start);
    for (int32_t i = 0; i < EDGE_MOVES; i++) {
        double time;
        if (!time_of_touch(p->job, now, v, 0.0, &time)) {
            break;
        }
        p->time = time;
        p->centre = centre_at(p->job, time);
        now = rlf_mad(patch_edge(p, face), v, -rlf_max(0.0, time));
    }
    return rlf_mad(now, v, rlf_max(0.0, p->time));
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

/* The contact points from the edge to the ball's centre. So does the way from the mean of the
 * pixels that the ball all but touches, and what is wrong with the one is not with the other. */
static bool face_edge(grid_patch *p, grid_meeting *touch, patch_mean *touched)
{
    rlf_vec3 edge = meet_edge(p, touched);
    touch->time = p->time;
    rlf_vec3 way = rlf_sub(p->centre, edge), direction = rlf_normalize(way);
    if (rlf_dot(direction, touched->normal) < BEHIND) {
        return false;
    }
    rlf_vec3 mean = rlf_normalize(rlf_sub(p->centre, touched->point));
    touched->normal = rlf_normalize(rlf_add(direction, mean));
    touched->point = rlf_mad(p->centre, touched->normal, -rlf_length(way));
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
    *out = mean_of(&p);
    if (p.face == GRID_TOUCH_BACK) {
        face_back(&p, out);
    } else if (is_supported(&p, out)) {
        correct_bulge(&p, out);
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
    double height = rlf_dot(touched->normal, rlf_sub(centre_at(job, first), point));
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
        if (is_found && (first < 0.0 || is_met(job, &touched, time, first))) {
            add_hit(job, time, &touched, label);
            first = first < 0.0 ? time : first;
        }
    }
}
