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

static bool has_direction(const rlf_map_point *there)
{
    return there->state != RLF_MAP_UNKNOWN && rlf_dot(there->gradient, there->gradient) > 0.5;
}

/* Beside what it knows the map tells a distance, but not which way. */
static bool is_told(const rlf_map_point *there)
{
    return has_direction(there) || there->is_far;
}

/* A map keeps no space that is far from any surface. It is free if the way from there towards the
 * camera comes to what is known to be free, over a face that looks to where the way began, before
 * it comes to what the camera sees; and in the solid if it comes to a face's back. */
static bool is_open_space(const grid_query *query, rlf_vec3 q)
{
    double truncation = rlf_map_truncation(query->map), distance = rlf_length(q);
    rlf_vec3 way = rlf_scale(q, -1.0 / rlf_max(distance, 1e-9));
    rlf_vec3 way_in_world = rlf_rotate(query->grid->T_world_grid.q, way);
    double most = rlf_min(OPEN_FAR, distance);
    for (double gone = 0.5 * truncation; gone < most; gone += 0.5 * truncation) {
        rlf_vec3 p = rlf_mad(q, way, gone);
        rlf_map_point there =
            rlf_map_sample(query->map, rlf_transform(&query->grid->T_world_grid, p));
        if (mapped_is_seen(query->grid, p)) {
            return false;
        }
        if (there.state != RLF_MAP_UNKNOWN) {
            return there.state == RLF_MAP_FREE && rlf_dot(there.gradient, way_in_world) <= 0.0;
        }
    }
    return false;
}

bool mapped_distance(const grid_query *query, rlf_vec3 q, double *out)
{
    if (query->map == NULL) {
        return false;
    }
    const rlf_vec3 p = rlf_transform(&query->grid->T_world_grid, q);
    const rlf_map_point there = rlf_map_sample(query->map, p);
    *out = there.distance;
    return is_told(&there);
}

bool mapped_is_open(const grid_query *query, rlf_vec3 q)
{
    return query->map != NULL && !mapped_is_seen(query->grid, q) && is_open_space(query, q);
}

bool mapped_answers(const grid_query *query, rlf_vec3 q)
{
    double distance;
    return mapped_distance(query, q, &distance) || mapped_is_open(query, q);
}

rlf_map_state mapped_first_known(const grid_query *query, rlf_vec3 from, rlf_vec3 to)
{
    rlf_map_state state = RLF_MAP_UNKNOWN;
    if (query->map == NULL) {
        return state;
    }
    double length = rlf_length(rlf_sub(to, from));
    int32_t steps = 1 + (int32_t)(length / (STRIDE_SHARE * rlf_map_truncation(query->map)));
    rlf_vec3 p = rlf_transform(&query->grid->T_world_grid, from);
    rlf_vec3 step = rlf_rotate(query->grid->T_world_grid.q, rlf_sub(to, from));
    step = rlf_scale(step, 1.0 / steps);
    for (int32_t i = 0; i <= steps && state == RLF_MAP_UNKNOWN; i++) {
        state = rlf_map_sample(query->map, rlf_mad(p, step, i)).state;
    }
    return state;
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
        if (has_direction(&there) && there.distance < margin && is_coming) {
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
