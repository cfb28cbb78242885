/* A body against unseen posts: where their axes are nearest to it, and beside that. */
#include "physics/grid/post_hit.h"
#include "physics/grid/line.h"
#include "physics/grid/post.h"

#define LEVEL_MIN                                                                                  \
    0.3 /* sine of the angle between a body's face and the floor: it leans on a post */

/* Away from the post, level: across the body's face that meets it or, where that lies flat, to the
 * body's centre. */
static rlf_vec3 way_out(const grid_job *job, rlf_vec3 p, rlf_vec3 normal)
{
    rlf_vec3 up = job->query->up;
    rlf_vec3 level = rlf_mad(normal, up, -rlf_dot(normal, up));
    if (rlf_length(level) < LEVEL_MIN) {
        level = rlf_sub(job->centre, p);
        level = rlf_mad(level, up, -rlf_dot(level, up));
    }
    return rlf_normalize(level);
}

static void touch_post(grid_job *job, const grid_post *post, double height)
{
    rlf_vec3 p = rlf_mad(post->foot, job->query->up, height), gradient;
    rlf_vec3 local = grid_to_body(job, p);
    double distance = phys_shape_distance(&job->body->shape, local, &gradient);
    rlf_vec3 normal = rlf_neg(rlf_mat3_mul_vec(&job->R_grid_body, gradient));
    grid_hit hit = {.anchor = rlf_mad(local, gradient, -distance)};
    hit.normal = hit.facing = way_out(job, p, normal);
    hit.point = rlf_mad(p, hit.normal, post->radius);
    rlf_vec3 r = rlf_mat3_mul_vec(&job->R_grid_body, hit.anchor);
    hit.separation = rlf_dot(hit.normal, rlf_sub(rlf_add(job->centre, r), hit.point));
    double approach = -rlf_dot(hit.normal, rlf_add(job->v, rlf_cross(job->w, r)));
    if (distance - post->radius < GRID_MARGIN + rlf_max(0.0, approach) * job->horizon &&
        rlf_dot(hit.normal, hit.normal) > 0.5 && job->hit_count < GRID_HITS_MAX) {
        job->hits[job->hit_count++] = hit;
    }
}

static double distance_of(const grid_job *job, const grid_post *post)
{
    return grid_post_distance(post, job->query->up, job->centre);
}

void grid_posts_collide(grid_job *job)
{
    const grid_query *query = job->query;
    for (int32_t i = 0; query->shell != NULL && i < query->posts->count; i++) {
        const grid_post *post = &query->posts->posts[i];
        double free = rlf_max(distance_of(job, post), 0.0);
        job->nearest2 = rlf_min(job->nearest2, free * free);
        if (free > job->reach) {
            continue;
        }
        double half = 0.5 * job->body->shape.inner_radius;
        double height = grid_line_nearest(job, post->foot, query->up, post->height);
        touch_post(job, post, height);
        touch_post(job, post, rlf_max(height - half, 0.0));
        touch_post(job, post, rlf_min(height + half, post->height));
    }
}

double grid_posts_distance(const grid_job *job, double wide)
{
    const grid_query *query = job->query;
    for (int32_t i = 0; query->shell != NULL && i < query->posts->count; i++) {
        wide = rlf_min(wide, distance_of(job, &query->posts->posts[i]));
    }
    return wide;
}
