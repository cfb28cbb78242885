/* Where a line enters and leaves a shape. */
#include "physics/shape/shape.h"

/* The part of a line that is inside something, by its parameter; empty when enter > leave. */
typedef struct span {
    double enter, leave;
} span;

static const span NOTHING = {1.0, -1.0}, EVERYTHING = {-1e30, 1e30};

static span meet(span a, span b)
{
    return (span){rlf_max(a.enter, b.enter), rlf_min(a.leave, b.leave)};
}

/* Inside where low <= p + t d <= high. */
static span slab(double p, double d, double low, double high)
{
    if (d == 0.0) {
        return p >= low && p <= high ? EVERYTHING : NOTHING;
    }
    double a = (low - p) / d, b = (high - p) / d;
    return (span){rlf_min(a, b), rlf_max(a, b)};
}

/* Inside where a t^2 + 2 b t + c <= 0, a >= 0. */
static span quadratic(double a, double b, double c)
{
    if (!(a > 1e-30)) {
        return c <= 0.0 ? EVERYTHING : NOTHING;
    }
    double root = b * b - a * c;
    if (!(root >= 0.0)) {
        return NOTHING;
    }
    root = sqrt(root);
    return (span){(-b - root) / a, (-b + root) / a};
}

static span box_span(rlf_vec3 size, rlf_vec3 o, rlf_vec3 d)
{
    span s = slab(o.x, d.x, -0.5 * size.x, 0.5 * size.x);
    s = meet(s, slab(o.y, d.y, -0.5 * size.y, 0.5 * size.y));
    return meet(s, slab(o.z, d.z, -0.5 * size.z, 0.5 * size.z));
}

static span ball_span(double radius, rlf_vec3 o, rlf_vec3 d)
{
    return quadratic(rlf_dot(d, d), rlf_dot(o, d), rlf_dot(o, o) - radius * radius);
}

static span cylinder_span(const rlf_shape *s, rlf_vec3 o, rlf_vec3 d)
{
    span round = quadratic(d.x * d.x + d.z * d.z, o.x * d.x + o.z * d.z,
                           o.x * o.x + o.z * o.z - s->radius * s->radius);
    return meet(round, slab(o.y, d.y, -0.5 * s->height, 0.5 * s->height));
}

/* Hull of the three: one interval, as the capsule is convex. */
static span capsule_span(const rlf_shape *s, rlf_vec3 o, rlf_vec3 d)
{
    rlf_vec3 half = rlf_vec3_make(0, 0.5 * s->height, 0);
    const span parts[3] = {cylinder_span(s, o, d), ball_span(s->radius, rlf_sub(o, half), d),
                           ball_span(s->radius, rlf_add(o, half), d)};
    span all = NOTHING;
    for (int i = 0; i < 3; i++) {
        if (parts[i].enter <= parts[i].leave) {
            bool is_first = all.enter > all.leave;
            all.enter = is_first ? parts[i].enter : rlf_min(all.enter, parts[i].enter);
            all.leave = is_first ? parts[i].leave : rlf_max(all.leave, parts[i].leave);
        }
    }
    return all;
}

/* Cut by the plane of every face (Cyrus and Beck 1978). */
static span hull_span(const rlf_hull *hull, rlf_vec3 o, rlf_vec3 d)
{
    span s = EVERYTHING;
    for (int32_t i = 0; i < hull->triangle_count && s.enter <= s.leave; i++) {
        const int32_t *corner = hull->triangles + 3 * (ptrdiff_t)i;
        rlf_vec3 a = hull->vertices[corner[0]];
        rlf_vec3 n =
            rlf_cross(rlf_sub(hull->vertices[corner[1]], a), rlf_sub(hull->vertices[corner[2]], a));
        double height = rlf_dot(n, rlf_sub(o, a)), slope = rlf_dot(n, d);
        if (slope < 0.0) {
            s.enter = rlf_max(s.enter, -height / slope);
        } else if (slope > 0.0) {
            s.leave = rlf_min(s.leave, -height / slope);
        } else if (height > 0.0) {
            s = NOTHING;
        }
    }
    return s;
}

bool rlf_shape_cast(const rlf_shape *shape, rlf_vec3 origin, rlf_vec3 direction, double *out_enter,
                    double *out_leave)
{
    span s = NOTHING;
    if (!RLF_ASSERT(phys_shape_is_whole(shape) && out_enter != NULL && out_leave != NULL)) {
        return false;
    }
    switch (shape->type) {
    case RLF_SHAPE_BOX: s = box_span(shape->size, origin, direction); break;
    case RLF_SHAPE_SPHERE: s = ball_span(shape->radius, origin, direction); break;
    case RLF_SHAPE_CAPSULE: s = capsule_span(shape, origin, direction); break;
    case RLF_SHAPE_CYLINDER: s = cylinder_span(shape, origin, direction); break;
    case RLF_SHAPE_HULL: s = hull_span(shape->hull, origin, direction); break;
    }
    *out_enter = s.enter;
    *out_leave = s.leave;
    return s.enter <= s.leave;
}
