/* Points against flat tiles and boxes. */
#include "physics/grid/near.h"

/* The sheet goes on beside what is seen for half a pixel, and across small holes. */
#define PATCH_PX 2.5

/* Whether the point at `anchor` can come to one of the flat tiles. */
static bool is_over_flat(const grid_job *job, rlf_vec3 anchor)
{
    const double BAND = 0.02; /* a tile's plane is that of its pixels up to noise and relief */
    rlf_vec3 r = rlf_mat3_mul_vec(&job->R_grid_body, anchor);
    rlf_vec3 v = rlf_add(job->v, rlf_cross(job->w, r));
    rlf_vec3 q = rlf_add(job->centre, r);
    for (int32_t i = 0; i < job->flat_count; i++) {
        const grid_tile *tile = job->flats[i];
        double approach = rlf_dot(tile->normal, rlf_sub(tile->velocity, v));
        rlf_vec3 seen = rlf_mad(q, tile->velocity, -job->query->tau);
        double height = rlf_dot(tile->normal, seen) - tile->offset;
        if (height < BAND + rlf_max(0.0, approach) * job->horizon) {
            return true;
        }
    }
    return false;
}

/* The place of a point of the body as the sheet was seen, and how far it comes until the next
 * query, metres. */
static rlf_vec3 place_of(const grid_job *job, rlf_vec3 anchor, double *out_way)
{
    rlf_vec3 r = rlf_mat3_mul_vec(&job->R_grid_body, anchor);
    rlf_vec3 v = rlf_sub(rlf_add(job->v, rlf_cross(job->w, r)), job->surface_velocity);
    *out_way = rlf_length(v) * job->horizon;
    return rlf_mad(rlf_add(job->centre, r), job->surface_velocity, -job->query->tau);
}

/* Those that can come to one of the boxes. */
static uint32_t near_solids(const grid_job *job, const rlf_vec3 *points, int32_t count)
{
    float x[GRID_NEAR_MAX], y[GRID_NEAR_MAX], z[GRID_NEAR_MAX], distance2[GRID_NEAR_MAX];
    double ways[GRID_NEAR_MAX];
    double beside = PATCH_PX * job->centre.z * job->query->grid->pixel_angle + 2.0 * GRID_MARGIN;
    uint32_t near = 0;
    for (int32_t k = 0; k < GRID_NEAR_MAX; k++) {
        rlf_vec3 q = place_of(job, points[k < count ? k : 0], &ways[k]);
        x[k] = (float)q.x;
        y[k] = (float)q.y;
        z[k] = (float)q.z;
    }
    rlf_kernel_boxes_distance2(job->solids, job->solid_count, x, y, z, distance2);
    for (int32_t k = 0; k < count; k++) {
        double limit = ways[k] + beside;
        near |= (uint32_t)((double)distance2[k] < limit * limit) << k;
    }
    return near;
}

uint32_t grid_points_near(const grid_job *job, const rlf_vec3 *points, int32_t count)
{
    bool is_told = job->is_flat || (job->is_listed && job->home.side != FIELD_INSIDE);
    if (!is_told) {
        return ((uint32_t)1 << count) - 1u;
    }
    uint32_t near = job->is_flat ? 0 : near_solids(job, points, count);
    for (int32_t k = 0; k < count; k++) {
        if ((near >> k & 1u) == 0 && is_over_flat(job, points[k])) {
            near |= (uint32_t)1 << k;
        }
    }
    return near;
}
