/* What a ball's touches say.
 *
 * At the place where the ball is then, the pixels that it all but touches give a plane, each with a
 * weight that falls with its distance: noise averages out, and a curved surface is met where it is
 * nearest. Where that plane ends before the ball's centre is above it, the ball meets an edge, and
 * the contact points from the edge to the centre. */
#include "physics/grid/ball/ball.h"

#define EDGE_MOVES 6
#define PLANE_NEAR (2.0 * GRID_MARGIN) /* metres: a plane through a sample, up to noise */
#define MOVES 4                        /* of the patch to the pixel that is touched first */

/* Pixels this far apart span the patch that a ball all but touches: radius sqrt(2 r band). */
static int32_t patch_step(const grid_job *job, double z)
{
    double radius = sqrt(2.0 * job->body->shape.shape.radius * patch_band(z));
    return 1 + (int32_t)(radius / (z * job->query->grid->pixel_angle * PATCH_PX));
}

/* Moves the patch to the pixel that the ball reaches first. False when it has none. */
static bool settle(grid_patch *p, const grid_touch *touch)
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
        if (grid_ball_time(job, now, s->cell.velocity, 0.0, &time)) {
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
    int32_t x, y;
    field_cell cell;
    if (!grid_pixel_of(grid, seen, &x, &y)) {
        return false;
    }
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
        if (rlf_dot(job->hits[i].normal, normal) > SAME_FACE_COS) {
            return true;
        }
    }
    return false;
}

/* Adds the plane that was found unless the ball does not come to it before the next query. */
static void add_hit(grid_job *job, double time, const patch_mean *touched, int32_t label)
{
    double radius = job->body->shape.shape.radius;
    double closing = rlf_dot(touched->normal, rlf_sub(touched->velocity, job->motion.v));
    grid_hit hit = {.normal = touched->normal, .velocity = touched->velocity, .label = label};
    hit.rounding = radius;
    hit.point = rlf_mad(touched->point, touched->velocity, -time); /* where it is now */
    hit.separation = rlf_dot(hit.normal, rlf_sub(job->motion.centre, hit.point)) - radius;
    double near = GRID_MARGIN + rlf_max(0.0, closing) * job->window.horizon;
    if (hit.separation < near && job->hit_count < GRID_HITS_MAX) {
        job->hits[job->hit_count++] = hit;
    }
}

/* Where a face ends before its point under the ball's centre: where it meets other seen faces; else
 * at the nearest sample. */
typedef struct face_end {
    patch_corner corner;
    rlf_vec3 sample;
} face_end;

/* Pixels that are no averages over time are not asked for their planes' corner. */
static face_end find_end(const grid_patch *p, const patch_mean *mean, bool is_averaged)
{
    face_end end = {.sample = p->samples[p->nearest].point};
    if (is_averaged) {
        (void)corner_find(p, mean, &end.corner);
    }
    return end;
}

/* The end's point that is nearest to the ball's centre. */
static rlf_vec3 end_nearest(const face_end *end, rlf_vec3 centre)
{
    return end->corner.count > 1 ? corner_nearest(&end->corner, centre) : end->sample;
}

/* Replaces the mean's plane by the one near the nearest sample that holds most samples. */
static void find_face(const grid_patch *p, patch_mean *mean)
{
    patch_plane plane;
    if (plane_find(p, p->samples[p->nearest].point, PLANE_NEAR, NULL, 0, &plane)) {
        mean->normal = plane.normal;
        mean->point = plane.point;
    }
}

/* When the ball comes to the end of the face, which stands out beyond the pixels that show it, and
 * where on it. False when it does not before the next query: pixels are noted for balls that are
 * wider by what is between them. */
static bool meet_end(const grid_patch *p, const face_end *end, const patch_mean *face, double *time,
                     rlf_vec3 *out)
{
    double start = rlf_max(0.0, p->time);
    rlf_vec3 v = face->velocity, edge = end->sample;
    bool is_reached = false;
    for (int32_t i = 0; i < EDGE_MOVES; i++) {
        double later = rlf_max(0.0, *time) - start;
        rlf_vec3 centre = rlf_mad(patch_centre_at(p->job, *time), v, -later);
        edge = end_nearest(end, centre);
        double next;
        if (grid_ball_time(p->job, rlf_mad(edge, v, -start), v, 0.0, &next)) {
            *time = next;
            is_reached = true;
        } else if (is_reached || *time >= p->job->window.horizon) {
            break;
        } else {
            *time = p->job->window.horizon;
        }
    }
    *out = rlf_mad(edge, v, rlf_max(0.0, *time) - start);
    return is_reached;
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
 * touched point to the ball's centre, the point is no part of such a plane. False where the ball
 * cannot meet it. */
static bool face_back(const grid_patch *p, patch_mean *touched)
{
    const patch_sample *nearest = &p->samples[p->nearest];
    rlf_vec3 direction = rlf_normalize(rlf_sub(p->centre, nearest->point));
    touched->normal = grid_back_normal(p->job->query->grid, p->job->sheet, &nearest->cell);
    if (rlf_dot(touched->normal, direction) < APART_COS) {
        touched->normal = direction;
        touched->point = nearest->point;
    }
    return grid_ball_may_meet_back(&nearest->cell, nearest->point, touched->normal);
}

/* The contact points from the edge to the ball's centre. */
static bool face_edge(grid_patch *p, grid_touch *touch, patch_mean *touched)
{
    look_closer(p, touched);
    if (p->nearest < 0) {
        return false;
    }
    bool is_averaged = p->job->sheet->velocity_x == NULL;
    if (is_averaged) {
        find_face(p, touched);
    }
    const face_end end = find_end(p, touched, is_averaged);
    double time = p->time;
    rlf_vec3 edge;
    if (!meet_end(p, &end, touched, &time, &edge)) {
        return false;
    }
    touch->time = time;
    rlf_vec3 centre = patch_centre_at(p->job, time), way = rlf_sub(centre, edge);
    rlf_vec3 direction = rlf_normalize(way);
    if (rlf_dot(direction, touched->normal) < GRID_BALL_BEHIND) {
        return false;
    }
    rlf_vec3 mean = rlf_normalize(rlf_sub(centre, touched->point));
    touched->normal = is_averaged ? direction : rlf_normalize(rlf_add(direction, mean));
    touched->point = rlf_mad(centre, touched->normal, -rlf_length(way));
    return true;
}

static bool touch_face(const grid_job *job, grid_touch *touch, patch_mean *out, int32_t *label)
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
        return face_back(&p, out);
    }
    if (!is_supported(&p, out)) {
        return face_edge(&p, touch, out);
    }
    patch_correct_bulge(&p, out);
    return true;
}

/* The wall's direction is smoother than that to the one line of it that was noted: the plane that
 * faces it is where the ball is when it comes to that line. */
static bool touch_wall(const grid_job *job, const grid_touch *touch, patch_mean *out,
                       int32_t *label)
{
    field_cell cell;
    if (!grid_cell_read(job->query->grid, job->sheet, touch->x, touch->y, &cell)) {
        return false;
    }
    *label = cell.label;
    out->velocity = cell.velocity;
    out->normal = touch->direction;
    rlf_vec3 centre = patch_centre_at(job, touch->time);
    rlf_vec3 point = rlf_mad(touch->point, cell.velocity, rlf_max(0.0, touch->time));
    out->point = rlf_mad(centre, out->normal, -rlf_length(rlf_sub(centre, point)));
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

/* What a touch's pixels say. Pixels are noted for balls that are wider, by unlike amounts: only the
 * time that is found tells which touch is the first. */
typedef struct found_touch {
    patch_mean touched;
    double time;
    int32_t label;
} found_touch;

static int32_t find_touches(const grid_job *job, found_touch *out)
{
    int32_t count = 0;
    for (int32_t k = 0; k < job->touch_count; k++) {
        grid_touch touch = job->touches[k];
        found_touch *found = &out[count];
        bool is_wall = touch.face == GRID_TOUCH_SIDE;
        count += is_wall ? touch_wall(job, &touch, &found->touched, &found->label)
                         : touch_face(job, &touch, &found->touched, &found->label);
        found->time = touch.time;
    }
    return count;
}

void grid_ball_add_hits(grid_job *job)
{
    found_touch touches[GRID_TOUCHES_MAX];
    int32_t count = find_touches(job, touches);
    double first = -1.0;
    while (count > 0) {
        int32_t i = 0;
        for (int32_t j = 1; j < count; j++) {
            i = touches[j].time < touches[i].time ? j : i;
        }
        const found_touch *found = &touches[i];
        double time = rlf_max(0.0, found->time);
        if (first < 0.0 ||
            (is_met(job, &found->touched, time, first) && !is_known(job, found->touched.normal))) {
            add_hit(job, time, &found->touched, found->label);
            first = first < 0.0 ? time : first;
        }
        touches[i] = touches[--count];
    }
}
