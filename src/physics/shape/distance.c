/* Signed distance to a shape's surface, and its farthest points. */
#include "physics/shape/convex.h"
#include "physics/shape/shape.h"

static double box_distance(rlf_vec3 half, rlf_vec3 p, rlf_vec3 *gradient)
{
    double s[3] = {p.x < 0 ? -1.0 : 1.0, p.y < 0 ? -1.0 : 1.0, p.z < 0 ? -1.0 : 1.0};
    double d[3] = {s[0] * p.x - half.x, s[1] * p.y - half.y, s[2] * p.z - half.z};
    int32_t axis = d[0] > d[1] ? 0 : 1;
    axis = d[axis] > d[2] ? axis : 2;
    if (d[axis] <= 0.0) { /* inside: the nearest face */
        *gradient =
            rlf_vec3_make(axis == 0 ? s[0] : 0.0, axis == 1 ? s[1] : 0.0, axis == 2 ? s[2] : 0.0);
        return d[axis];
    }
    rlf_vec3 out =
        rlf_vec3_make(s[0] * rlf_max(d[0], 0), s[1] * rlf_max(d[1], 0), s[2] * rlf_max(d[2], 0));
    double length = rlf_length(out);
    *gradient = rlf_scale(out, 1.0 / length);
    return length;
}

static double ball_distance(double radius, rlf_vec3 p, rlf_vec3 *gradient)
{
    double length = rlf_length(p);
    *gradient = length > 0.0 ? rlf_scale(p, 1.0 / length) : rlf_vec3_make(0, -1, 0);
    return length - radius;
}

/* A rectangle in the half plane of (distance from the axis, y). */
static double cylinder_distance(const rlf_shape *s, rlf_vec3 p, rlf_vec3 *gradient)
{
    double r = sqrt(p.x * p.x + p.z * p.z);
    rlf_vec3 out = r > 0.0 ? rlf_vec3_make(p.x / r, 0, p.z / r) : rlf_vec3_make(1, 0, 0);
    double sign = p.y < 0 ? -1.0 : 1.0;
    double dr = r - s->radius;
    double dy = sign * p.y - 0.5 * s->height;
    if (dr <= 0.0 || dy <= 0.0) {
        *gradient = dr > dy ? out : rlf_vec3_make(0, sign, 0);
        return rlf_max(dr, dy);
    }
    double length = sqrt(dr * dr + dy * dy);
    *gradient = rlf_add(rlf_scale(out, dr / length), rlf_vec3_make(0, sign * dy / length, 0));
    return length;
}

static phys_plane plane_at(const rlf_hull *hull, const phys_plane *planes, int32_t i)
{
    return planes != NULL ? planes[i] : phys_plane_of_triangle(hull, i);
}

/* Nearest point of the faces that p is before; `least` is the distance to the farthest plane. */
static double outside_hull(const rlf_hull *hull, const phys_plane *planes, int32_t count,
                           rlf_vec3 p, double least, rlf_vec3 *gradient)
{
    double nearest = 1e30;
    for (int32_t i = 0; i < count && nearest > least + 1e-12; i++) {
        phys_plane plane = plane_at(hull, planes, i);
        double height = rlf_dot(plane.normal, p) - plane.offset;
        if (!(height > 0.0) || height >= nearest) {
            continue;
        }
        const int32_t *t = hull->triangles + 3 * (ptrdiff_t)plane.triangle;
        const rlf_vec3 corner[3] = {rlf_sub(hull->vertices[t[0]], p),
                                    rlf_sub(hull->vertices[t[1]], p),
                                    rlf_sub(hull->vertices[t[2]], p)};
        rlf_vec3 to = convex_nearest_of_triangle(corner);
        double distance = rlf_length(to);
        if (distance < nearest) {
            nearest = distance;
            *gradient = distance > 1e-9 ? rlf_scale(to, -1.0 / distance) : plane.normal;
        }
    }
    return nearest;
}

/* Inside: the nearest plane. Triangles without area have no plane of their own. */
static double hull_distance(const rlf_hull *hull, const phys_plane *planes, int32_t count,
                            rlf_vec3 p, rlf_vec3 *gradient)
{
    double best = -1e30;
    for (int32_t i = 0; i < count; i++) {
        phys_plane plane = plane_at(hull, planes, i);
        double height = rlf_dot(plane.normal, p) - plane.offset;
        if (height > best && rlf_dot(plane.normal, plane.normal) > 0.5) {
            best = height;
            *gradient = plane.normal;
        }
    }
    return best > 0.0 ? outside_hull(hull, planes, count, p, best, gradient) : best;
}

static double distance_of(const rlf_shape *s, const phys_plane *planes, int32_t plane_count,
                          rlf_vec3 p, rlf_vec3 *out_gradient)
{
    switch (s->type) {
    case RLF_SHAPE_BOX: return box_distance(rlf_scale(s->size, 0.5), p, out_gradient);
    case RLF_SHAPE_SPHERE: return ball_distance(s->radius, p, out_gradient);
    case RLF_SHAPE_CAPSULE: {
        double half = 0.5 * s->height;
        rlf_vec3 to_axis = rlf_vec3_make(p.x, p.y - rlf_clamp(p.y, -half, half), p.z);
        return ball_distance(s->radius, to_axis, out_gradient);
    }
    case RLF_SHAPE_CYLINDER: return cylinder_distance(s, p, out_gradient);
    case RLF_SHAPE_HULL: return hull_distance(s->hull, planes, plane_count, p, out_gradient);
    }
    return 0.0;
}

double rlf_shape_distance(const rlf_shape *shape, rlf_vec3 p, rlf_vec3 *out_gradient)
{
    if (!RLF_ASSERT(phys_shape_is_whole(shape) && out_gradient != NULL)) {
        return 0.0;
    }
    int32_t triangle_count = shape->type == RLF_SHAPE_HULL ? shape->hull->triangle_count : 0;
    return distance_of(shape, NULL, triangle_count, p, out_gradient);
}

double phys_shape_distance(const phys_shape *shape, rlf_vec3 p, rlf_vec3 *out_gradient)
{
    return distance_of(&shape->shape, shape->planes, shape->plane_count, p, out_gradient);
}

/* The rim points that look in a direction that is not the axis. About level, the cylinder rolls:
 * the points follow it about its axis. */
static int32_t cylinder_support(const rlf_shape *s, rlf_vec3 direction, rlf_vec3 out[2],
                                double *out_rounding)
{
    const double LEVEL = 0.2; /* cosine to the axis */
    rlf_vec3 flat = rlf_vec3_make(direction.x, 0, direction.z);
    bool is_level = direction.y < LEVEL && direction.y > -LEVEL;
    *out_rounding = is_level ? s->radius : 0.0;
    if (rlf_dot(flat, flat) < 1e-6) {
        return 0; /* standing on its cap: the fixed rim points serve */
    }
    rlf_vec3 rim = rlf_scale(rlf_normalize(flat), s->radius);
    rlf_vec3 core = rlf_mad(rim, direction, -*out_rounding);
    out[0] = rlf_add(core, rlf_vec3_make(0, 0.5 * s->height, 0));
    out[1] = rlf_add(core, rlf_vec3_make(0, -0.5 * s->height, 0));
    return 2;
}

int32_t phys_shape_support(const phys_shape *shape, rlf_vec3 direction, rlf_vec3 out[2],
                           double *out_rounding)
{
    const rlf_shape *s = &shape->shape;
    double half = 0.5 * s->height;
    *out_rounding = s->radius;
    switch (s->type) {
    case RLF_SHAPE_SPHERE: out[0] = rlf_vec3_make(0, 0, 0); return 1;
    case RLF_SHAPE_CAPSULE:
        out[0] = rlf_vec3_make(0, half, 0);
        out[1] = rlf_vec3_make(0, -half, 0);
        return 2;
    case RLF_SHAPE_CYLINDER: return cylinder_support(s, direction, out, out_rounding);
    case RLF_SHAPE_BOX: break;
    case RLF_SHAPE_HULL:
        *out_rounding = 0.0;
        out[0] = convex_farthest(s, direction);
        return s->hull->vertex_count > PHYS_POINTS_MAX ? 1 : 0;
    }
    return 0;
}
