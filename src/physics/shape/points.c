/* Sample points of a shape's surface and its face planes, made once when a body is added. */
#include "physics/shape/shape.h"

static void add_point(phys_shape *s, rlf_vec3 p)
{
    if (s->point_count < PHYS_POINTS_MAX) {
        s->points[s->point_count++] = p;
    }
}

/* 8 corners, 12 middles of edges, 6 middles of faces: all of {-1, 0, 1}^3 but the centre, those
 * with more ones first. */
static void box_points(phys_shape *s)
{
    rlf_vec3 half = rlf_scale(s->shape.size, 0.5);
    for (int32_t ones = 3; ones >= 1; ones--) {
        for (int32_t i = 0; i < 27; i++) {
            int32_t x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
            if (x * x + y * y + z * z == ones) {
                add_point(s, rlf_vec3_make(x * half.x, y * half.y, z * half.z));
            }
        }
        if (ones == 3) {
            s->vertex_count = s->point_count;
        }
    }
}

static void ball_points(phys_shape *s)
{
    for (int32_t i = 0; i < 27; i++) {
        rlf_vec3 d = rlf_vec3_make(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (i != 13) {
            add_point(s, rlf_scale(rlf_normalize(d), s->shape.radius));
        }
    }
    s->vertex_count = s->point_count;
}

/* Rings of 8 points about the y axis at height y. */
static void ring(phys_shape *s, double y, double radius)
{
    for (int32_t i = 0; i < 8; i++) {
        double angle = i * (RLF_PI / 4.0);
        add_point(s, rlf_vec3_make(radius * rlf_cos(angle), y, radius * rlf_sin(angle)));
    }
}

static void tube_points(phys_shape *s)
{
    bool is_capsule = s->shape.type == RLF_SHAPE_CAPSULE;
    double half = 0.5 * s->shape.height;
    double r = s->shape.radius;
    ring(s, half, r);
    ring(s, -half, r);
    add_point(s, rlf_vec3_make(0, half + (is_capsule ? r : 0.0), 0));
    add_point(s, rlf_vec3_make(0, -half - (is_capsule ? r : 0.0), 0));
    s->vertex_count = s->point_count;
    ring(s, 0.0, r);
    if (is_capsule) {
        ring(s, half + r * 0.70710678118654752, r * 0.70710678118654752);
        ring(s, -half - r * 0.70710678118654752, r * 0.70710678118654752);
    }
}

/* Vertices, evenly thinned when there are many, then middles of triangles as far as there is
 * room. */
static void hull_points(phys_shape *s)
{
    const rlf_hull *hull = s->shape.hull;
    int32_t stride = 1 + (hull->vertex_count - 1) / PHYS_POINTS_MAX;
    for (int32_t i = 0; i < hull->vertex_count; i += stride) {
        add_point(s, hull->vertices[i]);
    }
    s->vertex_count = s->point_count;
    for (int32_t i = 0; i < hull->triangle_count; i++) {
        const int32_t *t = hull->triangles + 3 * i;
        rlf_vec3 sum =
            rlf_add(rlf_add(hull->vertices[t[0]], hull->vertices[t[1]]), hull->vertices[t[2]]);
        add_point(s, rlf_scale(sum, 1.0 / 3.0));
    }
}

phys_plane phys_plane_of_triangle(const rlf_hull *hull, int32_t triangle)
{
    const int32_t *t = hull->triangles + 3 * (ptrdiff_t)triangle;
    rlf_vec3 a = hull->vertices[t[0]];
    rlf_vec3 normal = rlf_normalize(
        rlf_cross(rlf_sub(hull->vertices[t[1]], a), rlf_sub(hull->vertices[t[2]], a)));
    return (phys_plane){normal, rlf_dot(normal, a), triangle};
}

static rlf_result hull_planes(phys_shape *s)
{
    const rlf_hull *hull = s->shape.hull;
    s->planes = rlf_alloc_array((size_t)hull->triangle_count, sizeof(phys_plane));
    if (s->planes == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < hull->triangle_count; i++) {
        phys_plane plane = phys_plane_of_triangle(hull, i);
        if (rlf_dot(plane.normal, plane.normal) > 0.5) { /* one without area bounds nothing */
            s->planes[s->plane_count++] = plane;
            s->inner_radius = rlf_min(s->inner_radius, plane.offset);
        }
    }
    if (s->plane_count < 4 || !(s->inner_radius > 0.0)) {
        phys_shape_finish(s);
        return rlf_fail(RLF_ERROR_INVALID, "body def: shape.hull: flat, inside out, or its origin "
                                           "lies outside: give a closed convex mesh about its "
                                           "centre of mass");
    }
    return RLF_OK;
}

rlf_result phys_shape_init(phys_shape *out, const rlf_shape *shape, rlf_vec3 *points)
{
    phys_shape empty = {.shape = *shape, .points = points};
    *out = empty;
    out->radius = rlf_shape_radius(shape);
    out->inner_radius = out->radius;
    switch (shape->type) {
    case RLF_SHAPE_BOX:
        out->inner_radius = 0.5 * rlf_min(shape->size.x, rlf_min(shape->size.y, shape->size.z));
        box_points(out);
        break;
    case RLF_SHAPE_SPHERE: ball_points(out); break;
    case RLF_SHAPE_CAPSULE:
        out->inner_radius = shape->radius;
        tube_points(out);
        break;
    case RLF_SHAPE_CYLINDER:
        out->inner_radius = rlf_min(shape->radius, 0.5 * shape->height);
        tube_points(out);
        break;
    case RLF_SHAPE_HULL: hull_points(out); return hull_planes(out);
    }
    return RLF_OK;
}

void phys_shape_finish(phys_shape *shape)
{
    rlf_free(shape->planes);
    shape->planes = NULL;
    shape->plane_count = 0;
}
