/* Planes that go on unseen, and where each of them counts. */
#include "physics/grid/hidden.h"
#include "physics/grid/level.h"
#include "physics/grid/upright.h"

/* Where a plane counts that the camera does not see. */
typedef bool (*where_fn)(const rlf_grid *grid, rlf_vec3 q);

/* The body's point against a plane where that counts. */
static void touch_plane(grid_job *job, const shell_plane *plane, where_fn is_there, rlf_vec3 anchor,
                        double rounding)
{
    rlf_vec3 r = rlf_mat3_mul_vec(&job->R_grid_body, anchor);
    r = rlf_mad(r, plane->normal, -rounding);
    rlf_vec3 q = rlf_add(job->centre, r);
    double approach = -rlf_dot(plane->normal, rlf_add(job->v, rlf_cross(job->w, r)));
    double separation = rlf_dot(plane->normal, q) - plane->offset;
    if (separation < GRID_MARGIN + rlf_max(0.0, approach) * job->horizon &&
        job->hit_count < GRID_HITS_MAX && is_there(job->query->grid, q)) {
        grid_hit hit = {.point = rlf_mad(q, plane->normal, -separation), .normal = plane->normal};
        hit.anchor = anchor;
        hit.rounding = rounding;
        hit.separation = separation;
        job->hits[job->hit_count++] = hit;
    }
}

/* The shell has no back: what a thin wall would push out behind it stays in the room. */
static void drop_backs(grid_job *job, const shell_plane *plane)
{
    const double NEAR = 0.05;
    int32_t kept = 0;
    for (int32_t i = 0; i < job->hit_count; i++) {
        const grid_hit *hit = &job->hits[i];
        bool is_back = rlf_dot(hit->normal, plane->normal) < -0.3 &&
                       rlf_dot(plane->normal, hit->point) - plane->offset < NEAR;
        if (!is_back) {
            job->hits[kept++] = *hit;
        }
    }
    job->hit_count = kept;
}

static void collide_plane(grid_job *job, const shell_plane *plane, where_fn is_there)
{
    const phys_shape *shape = &job->body->shape;
    rlf_vec3 core[2];
    double rounding;
    rlf_vec3 down = rlf_mat3_mul_vec(&job->R_body_grid, rlf_neg(plane->normal));
    int32_t count = phys_shape_support(shape, down, core, &rounding);
    drop_backs(job, plane);
    for (int32_t k = 0; k < count; k++) {
        touch_plane(job, plane, is_there, core[k], rounding);
    }
    for (int32_t k = 0; count == 0 && k < shape->vertex_count; k++) {
        touch_plane(job, plane, is_there, shape->points[k], 0.0);
    }
}

static double height_over(const grid_job *job, const shell_plane *plane)
{
    return rlf_dot(plane->normal, job->centre) - plane->offset;
}

/* The centre's height over the plane, which the scan's nearest is not beyond. */
static double come_near(grid_job *job, const shell_plane *plane)
{
    double height = height_over(job, plane);
    job->nearest2 = rlf_min(job->nearest2, rlf_max(height, 0.0) * rlf_max(height, 0.0));
    return height;
}

/* What stands behind what hides it, under or beside the body's centre, within `reach`. */
static bool find_upright(const grid_job *job, double reach, shell_plane *out)
{
    const grid_query *query = job->query;
    if (query->shell == NULL || !(rlf_dot(query->up, query->up) > 0.0)) {
        return false;
    }
    rlf_vec3 side = rlf_normalize(rlf_cross(query->up, job->centre));
    for (int32_t k = 0; k < 3; k++) {
        double shift = (k == 2 ? -1.0 : k) * job->body->shape.radius;
        rlf_vec3 q = rlf_mad(job->centre, side, shift);
        if (grid_shell_is_hidden(query->grid, q) &&
            grid_upright_find(query->grid, q, query->up, reach, out)) {
            return true;
        }
    }
    return false;
}

/* What is level under the body's centre, and hidden. */
static bool find_level(const grid_job *job, double reach, shell_plane *out)
{
    const grid_query *query = job->query;
    return query->shell != NULL &&
           grid_level_find(query->levels, query->grid, job->centre, reach, out);
}

void grid_hidden_collide(grid_job *job, double wide)
{
    const grid_query *query = job->query;
    for (int32_t i = 0; query->shell != NULL && i < query->shell->count; i++) {
        const shell_plane *plane = &query->shell->planes[i];
        if (come_near(job, plane) <= job->reach) {
            collide_plane(job, plane, grid_shell_is_hidden);
        }
    }
    shell_plane upright, level;
    if (find_upright(job, wide, &upright) && come_near(job, &upright) <= job->reach) {
        collide_plane(job, &upright, grid_shell_is_hidden);
    }
    if (find_level(job, wide, &level) && come_near(job, &level) <= job->reach) {
        collide_plane(job, &level, grid_level_is_hidden);
    }
}

double grid_hidden_shell_height(const grid_job *job, double wide)
{
    const grid_shell *shell = job->query->shell;
    for (int32_t i = 0; shell != NULL && i < shell->count; i++) {
        wide = rlf_min(wide, height_over(job, &shell->planes[i]));
    }
    return wide;
}

double grid_hidden_face_height(const grid_job *job, double wide)
{
    shell_plane face;
    double height = wide;
    if (find_upright(job, wide, &face)) {
        height = rlf_min(height, height_over(job, &face));
    }
    if (find_level(job, wide, &face)) {
        height = rlf_min(height, height_over(job, &face));
    }
    return height;
}
