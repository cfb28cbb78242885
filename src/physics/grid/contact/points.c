/* The body's own points against a layer: those that can touch it are cast along their way. */
#include "physics/grid/contact/search.h"

/* The sheet goes on beside what is seen for half a pixel, and across small holes. */
#define PATCH_PX 2.5

/* Whether the point at `anchor` can come to one of the flat tiles. */
static bool is_over_flat(const grid_job *job, rlf_vec3 anchor)
{
    const double BAND =
        2.0 * GRID_NOISE_M; /* a tile's plane is that of its pixels up to noise and relief */
    rlf_vec3 r = rlf_mat3_mul_vec(&job->motion.R_grid_body, anchor);
    rlf_vec3 v = rlf_add(job->motion.v, rlf_cross(job->motion.w, r));
    rlf_vec3 q = rlf_add(job->motion.centre, r);
    for (int32_t i = 0; i < job->scan.flat_count; i++) {
        const grid_tile *tile = job->scan.flats[i];
        double approach = rlf_dot(tile->normal, rlf_sub(tile->velocity, v));
        rlf_vec3 seen = rlf_mad(q, tile->velocity, -job->query->tau);
        double height = rlf_dot(tile->normal, seen) - tile->offset;
        if (height < BAND + rlf_max(0.0, approach) * job->window.horizon) {
            return true;
        }
    }
    return false;
}

/* The place of a point of the body as the sheet was seen, and how far it comes until the next
 * query, metres. */
static rlf_vec3 place_of(const grid_job *job, rlf_vec3 anchor, double *out_way)
{
    rlf_vec3 r = rlf_mat3_mul_vec(&job->motion.R_grid_body, anchor);
    rlf_vec3 v =
        rlf_sub(rlf_add(job->motion.v, rlf_cross(job->motion.w, r)), job->scan.surface_velocity);
    *out_way = rlf_length(v) * job->window.horizon;
    return rlf_mad(rlf_add(job->motion.centre, r), job->scan.surface_velocity, -job->query->tau);
}

/* Those that can come to one of the boxes. */
static uint32_t near_solids(const grid_job *job, const rlf_vec3 *points, int32_t count)
{
    float x[GRID_NEAR_MAX], y[GRID_NEAR_MAX], z[GRID_NEAR_MAX], distance2[GRID_NEAR_MAX];
    double ways[GRID_NEAR_MAX];
    double beside =
        PATCH_PX * job->motion.centre.z * job->query->grid->pixel_angle + 2.0 * GRID_MARGIN;
    uint32_t near = 0;
    for (int32_t k = 0; k < GRID_NEAR_MAX; k++) {
        rlf_vec3 q = place_of(job, points[k < count ? k : 0], &ways[k]);
        x[k] = (float)q.x;
        y[k] = (float)q.y;
        z[k] = (float)q.z;
    }
    rlf_kernel_boxes_distance2(job->scan.solids, job->scan.solid_count, x, y, z, distance2);
    for (int32_t k = 0; k < count; k++) {
        double limit = ways[k] + beside;
        near |= (uint32_t)((double)distance2[k] < limit * limit) << k;
    }
    return near;
}

uint32_t grid_points_near(const grid_job *job, const rlf_vec3 *points, int32_t count)
{
    bool is_told = job->scan.is_flat || (job->scan.is_listed && job->side.state != FIELD_INSIDE);
    if (!is_told) {
        return ((uint32_t)1 << count) - 1u;
    }
    uint32_t near = job->scan.is_flat ? 0 : near_solids(job, points, count);
    for (int32_t k = 0; k < count; k++) {
        if ((near >> k & 1u) == 0 && is_over_flat(job, points[k])) {
            near |= (uint32_t)1 << k;
        }
    }
    return near;
}

/* One surface point of the body along its way through the sheet's own moving frame. */
static void cast_point(grid_job *job, rlf_vec3 anchor, double rounding, rlf_vec3 normal)
{
    const grid_query *query = job->query;
    rlf_vec3 r = rlf_mat3_mul_vec(&job->motion.R_grid_body, anchor);
    r = rlf_mad(r, normal, -rounding);
    rlf_vec3 q = rlf_add(job->motion.centre, r);
    rlf_vec3 shift = rlf_scale(job->scan.surface_velocity, query->tau);
    rlf_vec3 v =
        rlf_sub(rlf_add(job->motion.v, rlf_cross(job->motion.w, r)), job->scan.surface_velocity);
    field_hit found;
    if (job->hit_count == GRID_HITS_MAX ||
        !grid_cast(query->grid, job->sheet, rlf_sub(q, shift), rlf_scale(v, job->window.horizon),
                   GRID_MARGIN, &job->side, &found)) {
        return;
    }
    grid_hit *hit = &job->hits[job->hit_count++];
    hit->point = rlf_add(found.point, shift);
    hit->normal = found.normal;
    hit->velocity = found.velocity;
    hit->anchor = anchor;
    hit->rounding = rounding;
    hit->separation = found.separation;
    hit->label = found.label;
    grid_follow_plane(job, hit, r, normal);
}

/* Whether the last hit is with a plane that a named point of a round body, of which there are
 * `named`, meets too: that one rolls along, and a fixed one beside it would push it on. */
static bool is_known(const grid_job *job, int32_t named)
{
    const grid_hit *last = &job->hits[job->hit_count - 1];
    for (int32_t k = 0; k < named; k++) {
        const grid_hit *hit = &job->hits[k];
        double off = rlf_dot(hit->normal, rlf_sub(last->point, hit->point));
        if (hit->rounding > 0.0 && rlf_dot(hit->normal, last->normal) > SAME_FACE_COS &&
            off < GRID_NOISE_M) {
            return true;
        }
    }
    return false;
}

static void cast_sample(grid_job *job, rlf_vec3 anchor, int32_t named)
{
    const rlf_vec3 none = {0, 0, 0};
    int32_t before = job->hit_count;
    cast_point(job, anchor, 0.0, none);
    if (job->hit_count > before && is_known(job, named)) {
        job->hit_count = before;
    }
}

/* The points that the shape names for the surface's directions. Returns whether there are any, and
 * all of a round body. */
static bool cast_named(grid_job *job)
{
    int32_t count = 0, round = 0;
    for (int32_t i = 0; i < job->scan.normal_count; i++) {
        rlf_vec3 core[2];
        double rounding;
        rlf_vec3 down = rlf_mat3_mul_vec(&job->motion.R_body_grid, rlf_neg(job->scan.normals[i]));
        int32_t named = phys_shape_support(&job->body->shape, down, core, &rounding);
        for (int32_t k = 0; k < named; k++) {
            cast_point(job, core[k], rounding, job->scan.normals[i]);
        }
        count += named;
        round += rounding > 0.0 ? named : 0;
    }
    return count > 0 && round == count;
}

/* On a plane a convex body stands on vertices, a round one on the points that its shape names. */
void grid_cast_points(grid_job *job)
{
    const phys_shape *shape = &job->body->shape;
    if (cast_named(job) && job->scan.is_flat) {
        return;
    }
    int32_t named = job->hit_count;
    int32_t count = job->scan.is_flat ? shape->vertex_count : shape->point_count;
    for (int32_t begin = 0; begin < count; begin += GRID_NEAR_MAX) {
        int32_t some = count - begin < GRID_NEAR_MAX ? count - begin : GRID_NEAR_MAX;
        uint32_t near = grid_points_near(job, shape->points + begin, some);
        for (int32_t i = 0; i < some; i++) {
            if ((near >> i & 1u) != 0) {
                cast_sample(job, shape->points[begin + i], named);
            }
        }
    }
}
