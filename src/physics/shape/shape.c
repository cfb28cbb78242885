/* What a shape is: its checks, its radius and its tensor of inertia (C.1 and its kin). */
#include "physics/shape/shape.h"

#define SIZE_MAX_M 100.0

static bool is_size(double value)
{
    return value > 0.0 && value <= SIZE_MAX_M;
}

/* The area vectors of a closed surface add up to nothing. */
static bool is_closed(const rlf_hull *hull)
{
    rlf_vec3 sum = {0, 0, 0};
    double area = 0.0;
    for (int32_t i = 0; i < hull->triangle_count; i++) {
        const int32_t *t = hull->triangles + 3 * (ptrdiff_t)i;
        rlf_vec3 a = hull->vertices[t[0]];
        rlf_vec3 n = rlf_cross(rlf_sub(hull->vertices[t[1]], a), rlf_sub(hull->vertices[t[2]], a));
        sum = rlf_add(sum, n);
        area += rlf_length(n);
    }
    return rlf_length(sum) <= 1e-6 * area;
}

static rlf_result check_hull(const rlf_hull *hull)
{
    if (hull == NULL || hull->vertices == NULL || hull->triangles == NULL) {
        return rlf_fail(RLF_ERROR_INVALID, "body def: shape.hull: set hull, vertices, triangles");
    }
    if (hull->vertex_count < 4 || hull->triangle_count < 4) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "body def: shape.hull: %d vertices and %d triangles: give at least 4 each",
                        (int)hull->vertex_count, (int)hull->triangle_count);
    }
    for (int32_t i = 0; i < hull->vertex_count; i++) {
        rlf_vec3 p = hull->vertices[i];
        if (!rlf_vec3_is_finite(p) || !(rlf_length(p) <= SIZE_MAX_M)) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "body def: shape.hull.vertices[%d]: not finite or "
                            "farther than 100 m: give metres",
                            (int)i);
        }
    }
    for (int32_t i = 0; i < 3 * hull->triangle_count; i++) {
        if (hull->triangles[i] < 0 || hull->triangles[i] >= hull->vertex_count) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "body def: shape.hull.triangles[%d]: index %d of %d vertices", (int)i,
                            (int)hull->triangles[i], (int)hull->vertex_count);
        }
    }
    if (!is_closed(hull)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "body def: shape.hull.triangles: not closed: give all faces, each "
                        "counter-clockwise seen from outside");
    }
    return RLF_OK;
}

rlf_result phys_shape_check(const rlf_shape *shape)
{
    switch (shape->type) {
    case RLF_SHAPE_BOX:
        if (!is_size(shape->size.x) || !is_size(shape->size.y) || !is_size(shape->size.z)) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "body def: shape.size: (%g, %g, %g): give metres "
                            "above 0 and up to 100",
                            shape->size.x, shape->size.y, shape->size.z);
        }
        return RLF_OK;
    case RLF_SHAPE_SPHERE:
    case RLF_SHAPE_CAPSULE:
    case RLF_SHAPE_CYLINDER:
        if (!is_size(shape->radius)) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "body def: shape.radius: %g: give metres above 0 and up to 100",
                            shape->radius);
        }
        if (shape->type != RLF_SHAPE_SPHERE && !is_size(shape->height)) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "body def: shape.height: %g: give metres above 0 and up to 100",
                            shape->height);
        }
        return RLF_OK;
    case RLF_SHAPE_HULL: return check_hull(shape->hull);
    }
    return rlf_fail(RLF_ERROR_INVALID, "body def: shape.type: %d is no shape", (int)shape->type);
}

bool phys_shape_is_whole(const rlf_shape *shape)
{
    return shape != NULL && (shape->type != RLF_SHAPE_HULL ||
                             (shape->hull != NULL && shape->hull->vertices != NULL &&
                              shape->hull->triangles != NULL));
}

double rlf_shape_radius(const rlf_shape *shape)
{
    if (!RLF_ASSERT(shape != NULL)) {
        return 0.0;
    }
    switch (shape->type) {
    case RLF_SHAPE_BOX: return 0.5 * rlf_length(shape->size);
    case RLF_SHAPE_SPHERE: return shape->radius;
    case RLF_SHAPE_CAPSULE: return 0.5 * shape->height + shape->radius;
    case RLF_SHAPE_CYLINDER: {
        double half = 0.5 * shape->height;
        return sqrt(half * half + shape->radius * shape->radius);
    }
    case RLF_SHAPE_HULL: break;
    }
    double radius = 0.0;
    for (int32_t i = 0; phys_shape_is_whole(shape) && i < shape->hull->vertex_count; i++) {
        radius = rlf_max(radius, rlf_length(shape->hull->vertices[i]));
    }
    return radius;
}

/* Integral of x x^T over the solid as a sum of signed tetrahedra with the origin (Blow and
 * Binstock 2004); I = tr(C) 1 - C, scaled to the mass. */
static rlf_mat3 hull_inertia(const rlf_hull *hull, double mass)
{
    double c[3][3] = {{0}};
    double volume = 0.0;
    for (int32_t i = 0; i < hull->triangle_count; i++) {
        const int32_t *t = hull->triangles + 3 * i;
        rlf_vec3 p[4] = {hull->vertices[t[0]], hull->vertices[t[1]], hull->vertices[t[2]]};
        p[3] = rlf_add(rlf_add(p[0], p[1]), p[2]);
        double det = rlf_dot(p[0], rlf_cross(p[1], p[2]));
        volume += det / 6.0;
        for (int32_t k = 0; k < 4; k++) {
            double v[3] = {p[k].x, p[k].y, p[k].z};
            for (int32_t row = 0; row < 9; row++) {
                c[row / 3][row % 3] += det / 120.0 * v[row / 3] * v[row % 3];
            }
        }
    }
    double s = volume > 0.0 ? mass / volume : 0.0;
    double trace = c[0][0] + c[1][1] + c[2][2];
    rlf_mat3 result;
    for (int32_t row = 0; row < 9; row++) {
        double diagonal = row / 3 == row % 3 ? trace : 0.0;
        result.m[row / 3][row % 3] = s * (diagonal - c[row / 3][row % 3]);
    }
    return result;
}

/* Solid cylinder between two half balls, by their shares of the volume. */
static rlf_mat3 capsule_inertia(double r, double h, double mass)
{
    double tube = h / (h + 4.0 / 3.0 * r) * mass;
    double ball = mass - tube;
    double axis = tube * 0.5 * r * r + ball * 0.4 * r * r;
    double side = tube * (r * r / 4.0 + h * h / 12.0) +
                  ball * (0.4 * r * r + h * h / 4.0 + 3.0 / 8.0 * h * r);
    return rlf_mat3_diagonal(side, axis, side);
}

rlf_mat3 rlf_shape_inertia(const rlf_shape *shape, double mass)
{
    if (!RLF_ASSERT(phys_shape_is_whole(shape))) {
        return rlf_mat3_diagonal(0, 0, 0);
    }
    double r2 = shape->radius * shape->radius;
    switch (shape->type) {
    case RLF_SHAPE_BOX: {
        double w2 = shape->size.x * shape->size.x;
        double h2 = shape->size.y * shape->size.y;
        double d2 = shape->size.z * shape->size.z;
        return rlf_mat3_diagonal(mass / 12.0 * (h2 + d2), mass / 12.0 * (w2 + d2),
                                 mass / 12.0 * (h2 + w2));
    }
    case RLF_SHAPE_SPHERE:
        return rlf_mat3_diagonal(0.4 * mass * r2, 0.4 * mass * r2, 0.4 * mass * r2);
    case RLF_SHAPE_CAPSULE: return capsule_inertia(shape->radius, shape->height, mass);
    case RLF_SHAPE_CYLINDER: {
        double side = mass * (r2 / 4.0 + shape->height * shape->height / 12.0);
        return rlf_mat3_diagonal(side, 0.5 * mass * r2, side);
    }
    case RLF_SHAPE_HULL: return hull_inertia(shape->hull, mass);
    }
    return rlf_mat3_diagonal(0, 0, 0);
}
