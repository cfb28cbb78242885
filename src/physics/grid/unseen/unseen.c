/* What is taken for solid where the camera does not look, and in which order.
 *
 * 1. What the layers measure: their own depth and thickness, and nothing where the camera looks
 *    through. No guess below counts where a layer has free space, nor where a map of the room
 *    knows what is there (mapped/mapped.h).
 * 2. What the picture's border cuts goes on beyond it (out_of_view.c): the body is searched at a
 *    place moved into view, and only contacts with what reaches the border count.
 * 3. The room's planes (room_planes.c) are solid without end where nothing is seen, and behind what
 *    hides them. A plane wins over the back of a layer there: what a thin wall would push out
 * behind the plane stays in the room. All hits go through one reduction, so that the deepest of a
 * direction counts.
 * 4. An upright face goes on downwards behind what hides it (upright_face.c), as a room's plane
 * does.
 *
 * Without RLF_BORDER_EXTEND 2 to 4 are off. */
#include "physics/grid/mapped/mapped.h"
#include "physics/grid/unseen/unseen.h"
#include "physics/grid/unseen/room_planes.h"

/* The room's planes push out whatever is behind them; a guessed face stops what comes to it. */
#define ENDLESS 1e9

/* Whether the camera does not see q, or where that is as it comes to the plane, `separation` metres
 * away: what falls may leave the picture before it touches. */
static bool is_hidden_way(const grid_job *job, rlf_vec3 q, rlf_vec3 v, double separation,
                          double approach)
{
    double time = approach > 0.0 ? rlf_max(0.0, separation) / approach : 0.0;
    const rlf_grid *grid = job->query->grid;
    return room_is_hidden(grid, q) ||
           (time > 0.0 && time <= job->window.horizon && room_is_hidden(grid, rlf_mad(q, v, time)));
}

/* The body's point against a plane where the camera does not see it, if it is no deeper in it. */
static void touch_plane(grid_job *job, const room_plane *plane, rlf_vec3 anchor, double rounding,
                        double deepest)
{
    rlf_vec3 r = rlf_mat3_mul_vec(&job->motion.R_grid_body, anchor);
    r = rlf_mad(r, plane->normal, -rounding);
    rlf_vec3 q = rlf_add(job->motion.centre, r);
    rlf_vec3 v = rlf_add(job->motion.v, rlf_cross(job->motion.w, r));
    double approach = -rlf_dot(plane->normal, v);
    double separation = room_plane_height(plane, q);
    if (separation > -deepest &&
        separation < GRID_MARGIN + rlf_max(0.0, approach) * job->window.horizon &&
        is_hidden_way(job, q, v, separation, approach) && !mapped_answers(job->query, q)) {
        grid_hit hit = {.point = rlf_mad(q, plane->normal, -separation), .normal = plane->normal};
        hit.anchor = anchor;
        hit.rounding = rounding;
        hit.separation = separation;
        grid_add_hit(job, &hit);
    }
}

/* Contacts that push the body behind the plane are dropped. */
static void drop_backs(grid_job *job, const room_plane *plane)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < job->hit_count; i++) {
        const grid_hit *hit = &job->hits[i];
        bool is_back = rlf_dot(hit->normal, plane->normal) < -ASIDE_COS &&
                       room_plane_height(plane, hit->point) < GRID_THIN_M;
        if (!is_back) {
            job->hits[kept++] = *hit;
        }
    }
    job->hit_count = kept;
}

static void collide_plane(grid_job *job, const room_plane *plane, double deepest)
{
    const phys_shape *shape = &job->body->shape;
    rlf_vec3 core[2];
    double rounding;
    rlf_vec3 down = rlf_mat3_mul_vec(&job->motion.R_body_grid, rlf_neg(plane->normal));
    int32_t count = phys_shape_support(shape, down, core, &rounding);
    drop_backs(job, plane);
    for (int32_t k = 0; k < count; k++) {
        touch_plane(job, plane, core[k], rounding, deepest);
    }
    for (int32_t k = 0; count == 0 && k < shape->vertex_count; k++) {
        touch_plane(job, plane, shape->points[k], 0.0, deepest);
    }
}

/* An upright face under which the body is, in the middle or at one of its sides. */
static bool find_upright(const grid_job *job, room_plane *out)
{
    const grid_query *query = job->query;
    if (query->room == NULL || !(rlf_dot(query->up, query->up) > 0.0)) {
        return false;
    }
    rlf_vec3 side = rlf_normalize(rlf_cross(query->up, job->motion.centre));
    for (int32_t k = -1; k <= 1; k++) {
        rlf_vec3 q = rlf_mad(job->motion.centre, side, k * job->body->shape.radius);
        if (room_is_hidden(query->grid, q) &&
            upright_face_find(query->grid, q, query->up, job->window.reach, out)) {
            return true;
        }
    }
    return false;
}

/* A plane against the body, when it is within reach. */
static void meet_plane(grid_job *job, const room_plane *plane, double deepest)
{
    double height = room_plane_height(plane, job->motion.centre);
    double gap = rlf_max(height, 0.0);
    job->scan.nearest2 = rlf_min(job->scan.nearest2, gap * gap);
    if (height <= job->window.reach) {
        collide_plane(job, plane, deepest);
    }
}

void grid_unseen_collide(grid_job *job)
{
    const room_planes *room = job->query->room;
    for (int32_t i = 0; room != NULL && i < room->count; i++) {
        meet_plane(job, &room->planes[i], ENDLESS);
    }
    room_plane upright;
    if (find_upright(job, &upright)) {
        meet_plane(job, &upright, GRID_NOISE_M);
    }
}
