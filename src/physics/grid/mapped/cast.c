/* A point's way through the map, and where the map answers at all. */
#include "physics/grid/mapped/mapped.h"

#include "relief/map.h"

#define STEPS_MAX 128
/* Shares of the truncation. A field made of views along slanted rays tells a little more than the
 * distance: only half of what it tells is gone at a time. */
#define STRIDE_SHARE 0.5
#define STRIDE_LEAST 0.125 /* about half a voxel */
/* A way along a surface, up to the map's noise, does not enter it. */
#define ALONG_COS 0.05
/* No back that is guessed is farther behind a face, metres. */
#define OPEN_FAR 0.5

bool mapped_is_seen(const rlf_grid *grid, rlf_vec3 q)
{
    field_cell cell;
    if (grid_field_is_open(grid, &grid->background, q)) {
        return true;
    }
    field_state state = FIELD_NONE;
    if (grid->background.depth != NULL && grid->background.normal_x != NULL) {
        state = grid_field_state(grid, &grid->background, q, &cell);
    }
    if (state == FIELD_NONE || state == FIELD_FRONT) {
        return state == FIELD_FRONT;
    }
    return rlf_dot(cell.normal, rlf_sub(q, cell.point)) > -GRID_NOISE_M;
}

/* A map keeps no space that is far from any surface. It is free if the way from there towards the
 * camera comes to what is known to be free, and in the solid if it comes to a face's back. */
static bool is_open_space(const grid_query *query, rlf_vec3 q)
{
    double truncation = rlf_map_truncation(query->map), distance = rlf_length(q);
    rlf_vec3 way = rlf_scale(q, -1.0 / rlf_max(distance, 1e-9));
    double most = rlf_min(OPEN_FAR, distance);
    for (double gone = truncation; gone < most; gone += truncation) {
        rlf_vec3 p = rlf_mad(q, way, gone);
        rlf_map_point there =
            rlf_map_sample(query->map, rlf_transform(&query->grid->T_world_grid, p));
        if (there.state != RLF_MAP_UNKNOWN) {
            return there.state == RLF_MAP_FREE;
        }
    }
    return false;
}

bool mapped_answers(const grid_query *query, rlf_vec3 q)
{
    if (query->map == NULL || mapped_is_seen(query->grid, q)) {
        return false;
    }
    rlf_vec3 p = rlf_transform(&query->grid->T_world_grid, q);
    return rlf_map_sample(query->map, p).state != RLF_MAP_UNKNOWN || is_open_space(query, q);
}

static bool has_direction(const rlf_map_point *there)
{
    return there->state != RLF_MAP_UNKNOWN && rlf_dot(there->gradient, there->gradient) > 0.5;
}

/* How far the point may go from there without a further look, metres. */
static double stride_at(const rlf_map_point *there, double truncation)
{
    double stride = STRIDE_SHARE * truncation; /* of what nobody knows, or has no face */
    if (there->state == RLF_MAP_FREE && !there->is_far) {
        stride = has_direction(there) ? STRIDE_SHARE * there->distance : 0.0;
    }
    return rlf_max(stride, STRIDE_LEAST * truncation);
}

bool mapped_cast(const grid_query *query, rlf_vec3 q, rlf_vec3 path, double margin,
                 mapped_touch *out)
{
    double length = rlf_length(path), truncation = rlf_map_truncation(query->map), gone = 0.0;
    rlf_vec3 way = rlf_scale(path, 1.0 / rlf_max(length, 1e-12));
    for (int32_t k = 0; k < STEPS_MAX; k++) {
        rlf_vec3 p = rlf_mad(q, way, gone);
        rlf_map_point there = rlf_map_sample(query->map, p);
        bool is_coming = gone <= 0.0 || rlf_dot(there.gradient, way) < -ALONG_COS;
        if (has_direction(&there) && there.distance < margin && is_coming &&
            !mapped_is_seen(query->grid, rlf_transform(&query->T_grid_world, p))) {
            out->point = rlf_mad(p, there.gradient, -there.distance);
            out->normal = there.gradient;
            out->separation = rlf_dot(out->normal, rlf_sub(q, out->point));
            return true;
        }
        if (gone >= length) {
            return false;
        }
        gone = rlf_min(gone + stride_at(&there, truncation), length);
    }
    return false;
}
