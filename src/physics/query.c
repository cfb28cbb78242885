/* Ray casts and overlaps against bodies and the sheets of the grid. */
#include "relief/query.h"

#include "physics/grid/cast.h"
#include "physics/world_state.h"

#define PIECE_PX 32.0 /* the sheet is walked in pieces of about so many pixels */
#define PIECES_MAX 512

/* Sphere tracing (Hart 1996): the distance to the shape is always a safe step. */
static void cast_at_body(const rlf_world *world, int32_t index, const rlf_vec3 ray[2],
                         rlf_ray_hit *hit)
{
    const double TOUCH = 1e-7;
    const phys_body *body = &world->bodies[index];
    rlf_vec3 along = rlf_sub(body->x, ray[0]);
    double closest = rlf_clamp(rlf_dot(along, ray[1]), 0.0, hit->distance);
    rlf_vec3 off = rlf_sub(rlf_mad(ray[0], ray[1], closest), body->x);
    if (rlf_dot(off, off) > body->shape.radius * body->shape.radius * (1.0 + 1e-9)) {
        return;
    }
    rlf_pose T_body_world = phys_body_pose(body);
    T_body_world = rlf_pose_invert(&T_body_world);
    rlf_vec3 origin = rlf_transform(&T_body_world, ray[0]);
    rlf_vec3 direction = rlf_rotate(T_body_world.q, ray[1]);
    double t = 0.0;
    for (int32_t i = 0; i < 256 && t < hit->distance; i++) {
        rlf_vec3 gradient;
        double d = phys_shape_distance(&body->shape, rlf_mad(origin, direction, t), &gradient);
        if (d < TOUCH) {
            hit->reason = RLF_QUERY_HIT;
            hit->other = RLF_CONTACT_BODY;
            hit->body = phys_body_id(world, index);
            hit->distance = t;
            hit->normal = t > 0.0 ? rlf_rotate(body->q, gradient) : rlf_neg(ray[1]);
            return;
        }
        t += d;
    }
}

static void set_surface_hit(const rlf_grid *grid, rlf_contact_other other, const field_hit *found,
                            double distance, rlf_ray_hit *hit)
{
    hit->reason = RLF_QUERY_HIT;
    hit->other = other;
    hit->body = (rlf_body_id){0, 0};
    hit->region_label = found->label;
    hit->distance = distance;
    hit->normal = rlf_rotate(grid->T_world_grid.q, found->normal);
}

/* Walks the ray through a sheet; hit->distance is the nearest hit so far. Grid frame. */
static void cast_at_sheet(const rlf_grid *grid, rlf_contact_other other, const rlf_vec3 ray[2],
                          rlf_ray_hit *hit)
{
    const rlf_grid_sheet *sheet =
        other == RLF_CONTACT_FOREGROUND ? &grid->foreground : &grid->background;
    field_cell cell;
    if (sheet->depth == NULL || sheet->normal_x == NULL) {
        return;
    }
    if (grid_field_at(grid, sheet, ray[0], &cell) == FIELD_INSIDE) {
        field_hit inside = {.normal = rlf_neg(ray[1]), .label = cell.label};
        set_surface_hit(grid, other, &inside, 0.0, hit);
        return;
    }
    const field_side nowhere = {.state = FIELD_NONE};
    double t = 0.0;
    for (int32_t i = 0; i < PIECES_MAX && t < hit->distance; i++) {
        rlf_vec3 q = rlf_mad(ray[0], ray[1], t);
        double piece = rlf_max(rlf_max(q.z, 0.1) * grid->pixel_angle * PIECE_PX, 0.001);
        piece = rlf_min(piece, hit->distance - t);
        field_hit found;
        if (grid_cast(grid, sheet, q, rlf_scale(ray[1], piece), 0.0, &nowhere, &found)) {
            double slope = rlf_dot(found.normal, ray[1]);
            double into = slope < -1e-6 ? -found.separation / slope : 0.0;
            t += rlf_clamp(into, 0.0, piece);
            set_surface_hit(grid, other, &found, rlf_min(t, hit->distance), hit);
            return;
        }
        t += piece;
    }
}

/* The shell of the last advance, where the camera does not see. Grid frame. */
static void cast_at_room(const rlf_world *world, const rlf_grid *grid, const rlf_vec3 ray[2],
                         rlf_ray_hit *hit)
{
    for (int32_t i = 0; phys_world_has_room(world, grid) && i < world->room.count; i++) {
        const room_plane *plane = &world->room.planes[i];
        double height = rlf_dot(plane->normal, ray[0]) - plane->offset;
        double slope = rlf_dot(plane->normal, ray[1]);
        double t = slope < 0.0 ? rlf_max(height, 0.0) / -slope : 1e30;
        if (t < hit->distance && room_is_hidden(grid, rlf_mad(ray[0], ray[1], t))) {
            field_hit found = {.normal = plane->normal};
            set_surface_hit(grid, RLF_CONTACT_BACKGROUND, &found, t, hit);
        }
    }
}

static bool overlaps_room(const rlf_world *world, const rlf_grid *grid, rlf_vec3 q, double radius)
{
    for (int32_t i = 0; phys_world_has_room(world, grid) && i < world->room.count; i++) {
        const room_plane *plane = &world->room.planes[i];
        double height = rlf_dot(plane->normal, q) - plane->offset;
        rlf_vec3 foot = rlf_mad(q, plane->normal, -rlf_max(height, 0.0));
        if (height <= radius && room_is_hidden(grid, foot)) {
            return true;
        }
    }
    return false;
}

/* What is known of the real world at q (grid frame), where nothing was met. */
static rlf_query_reason reason_at(const rlf_grid *grid, rlf_vec3 q)
{
    const rlf_grid_sheet *sheets[2] = {&grid->foreground, &grid->background};
    rlf_query_reason reason = RLF_QUERY_MISSING_DEPTH;
    double u, v;
    if (!(q.z > 0.0) || !grid->project(grid->project_context, q, &u, &v)) {
        return RLF_QUERY_OUTSIDE_VIEW;
    }
    for (int32_t i = 0; i < 2; i++) {
        field_cell cell;
        field_state state = FIELD_NONE;
        if (sheets[i]->depth != NULL && sheets[i]->normal_x != NULL) {
            state = grid_field_at(grid, sheets[i], q, &cell);
        }
        if (state == FIELD_BEHIND || state == FIELD_INSIDE) {
            return RLF_QUERY_BEHIND_SURFACE;
        }
        reason = state == FIELD_FRONT ? RLF_QUERY_MISS : reason;
    }
    return reason;
}

rlf_ray_hit rlf_world_cast_ray(const rlf_world *world, const rlf_grid *grid, rlf_vec3 origin,
                               rlf_vec3 direction, double length)
{
    rlf_ray_hit hit = {.reason = RLF_QUERY_INVALID};
    double norm = rlf_length(direction);
    if (!RLF_ASSERT(world != NULL) || !RLF_ASSERT(grid == NULL || grid_is_whole(grid)) ||
        !rlf_vec3_is_finite(origin) || !rlf_is_finite(norm) || !(norm > 0.0) ||
        !rlf_is_finite(length) || !(length > 0.0)) {
        return hit;
    }
    const rlf_vec3 ray[2] = {origin, rlf_scale(direction, 1.0 / norm)};
    hit.reason = RLF_QUERY_MISS;
    hit.distance = length;
    for (int32_t i = 0; i < world->body_top; i++) {
        if (world->bodies[i].is_alive) {
            cast_at_body(world, i, ray, &hit);
        }
    }
    if (grid != NULL) {
        rlf_pose T_grid_world = rlf_pose_invert(&grid->T_world_grid);
        const rlf_vec3 local[2] = {rlf_transform(&T_grid_world, ray[0]),
                                   rlf_rotate(T_grid_world.q, ray[1])};
        cast_at_sheet(grid, RLF_CONTACT_FOREGROUND, local, &hit);
        cast_at_sheet(grid, RLF_CONTACT_BACKGROUND, local, &hit);
        cast_at_room(world, grid, local, &hit);
        if (hit.reason != RLF_QUERY_HIT) {
            hit.reason = reason_at(grid, rlf_mad(local[0], local[1], length));
        }
    }
    hit.point = rlf_mad(ray[0], ray[1], hit.distance);
    return hit;
}

/* Whether a sheet's surface comes within `radius` of q (grid frame) or its solid holds q. */
static bool overlaps_sheet(const rlf_grid *grid, const rlf_grid_sheet *sheet, rlf_vec3 q,
                           double radius)
{
    field_cell cell;
    if (sheet->depth == NULL || sheet->normal_x == NULL) {
        return false;
    }
    if (grid_field_at(grid, sheet, q, &cell) == FIELD_INSIDE) {
        return true;
    }
    double u, v;
    if (!(q.z > 0.0) || !grid->project(grid->project_context, q, &u, &v)) {
        return false;
    }
    double half = radius / (rlf_max(q.z - radius, 0.1) * grid->pixel_angle) + 1.0;
    int32_t x0 = (int32_t)rlf_clamp(u - half, 0, grid->width);
    int32_t x1 = (int32_t)rlf_clamp(u + half + 1, 0, grid->width);
    int32_t y0 = (int32_t)rlf_clamp(v - half, 0, grid->height);
    int32_t y1 = (int32_t)rlf_clamp(v + half + 1, 0, grid->height);
    for (int32_t y = y0; y < y1; y++) {
        for (int32_t x = x0; x < x1; x++) {
            if (!grid_cell_read(grid, sheet, x, y, &cell)) {
                continue;
            }
            /* the side wall behind the pixel is solid too */
            double z = cell.point.z;
            double level = rlf_clamp(q.z, z, z + cell.thickness);
            rlf_vec3 d = rlf_sub(rlf_scale(cell.point, level / z), q);
            if (rlf_dot(d, d) <= radius * radius) {
                return true;
            }
        }
    }
    return false;
}

rlf_overlap rlf_world_overlap_sphere(const rlf_world *world, const rlf_grid *grid, rlf_vec3 centre,
                                     double radius, rlf_body_id *ids, int32_t capacity)
{
    rlf_overlap overlap = {.reason = RLF_QUERY_INVALID};
    if (!RLF_ASSERT(world != NULL && (ids != NULL || capacity <= 0)) ||
        !RLF_ASSERT(grid == NULL || grid_is_whole(grid)) || !rlf_vec3_is_finite(centre) ||
        !rlf_is_finite(radius) || !(radius > 0.0)) {
        return overlap;
    }
    overlap.reason = RLF_QUERY_MISS;
    for (int32_t i = 0; i < world->body_top; i++) {
        const phys_body *body = &world->bodies[i];
        rlf_vec3 gradient;
        rlf_vec3 local = rlf_rotate(rlf_quat_conjugate(body->q), rlf_sub(centre, body->x));
        double reach = body->shape.radius + radius;
        if (body->is_alive && rlf_dot(local, local) <= reach * reach &&
            phys_shape_distance(&body->shape, local, &gradient) <= radius) {
            if (overlap.body_count < capacity) {
                ids[overlap.body_count] = phys_body_id(world, i);
            }
            overlap.body_count++;
        }
    }
    rlf_vec3 q = centre;
    if (grid != NULL) {
        rlf_pose T_grid_world = rlf_pose_invert(&grid->T_world_grid);
        q = rlf_transform(&T_grid_world, centre);
        overlap.touches_background = overlaps_sheet(grid, &grid->background, q, radius) ||
                                     overlaps_room(world, grid, q, radius);
        overlap.touches_foreground = overlaps_sheet(grid, &grid->foreground, q, radius);
    }
    if (overlap.body_count > 0 || overlap.touches_background || overlap.touches_foreground) {
        overlap.reason = RLF_QUERY_HIT;
    } else if (grid != NULL) {
        overlap.reason = reason_at(grid, q);
    }
    return overlap;
}
