/* Rays against solids: intervals [near, far] in closed form. */
#include "sim/shape.h"

#define FAR_AWAY 1e9

/* Roots of a t^2 + 2 b t + c in increasing order; false when there are none or infinitely many. */
static bool solve_quadratic(double a, double b, double c, synth_interval *out)
{
    double discriminant = b * b - a * c;
    if (!(discriminant >= 0.0) || a == 0.0) {
        return false;
    }
    double root = sqrt(discriminant);
    double q = b > 0.0 ? -b - root : -b + root; /* without cancellation */
    double t1 = q / a;
    double t2 = q != 0.0 ? c / q : t1;
    out->near = rlf_min(t1, t2);
    out->far = rlf_max(t1, t2);
    return true;
}

static bool intersect_half_space(double o, double d, synth_interval *out)
{
    if (d == 0.0) {
        out->near = -FAR_AWAY;
        out->far = FAR_AWAY;
        return o >= 0.0;
    }
    double t = -o / d;
    out->near = d > 0.0 ? t : -FAR_AWAY;
    out->far = d > 0.0 ? FAR_AWAY : t;
    return true;
}

/* Slab method (Kay and Kajiya 1986). */
static bool intersect_box(rlf_vec3 size, rlf_vec3 o, rlf_vec3 d, synth_interval *out)
{
    const double origin[3] = {o.x, o.y, o.z};
    const double direction[3] = {d.x, d.y, d.z};
    const double half[3] = {size.x, size.y, size.z};
    out->near = -FAR_AWAY;
    out->far = FAR_AWAY;
    for (int i = 0; i < 3; i++) {
        if (direction[i] == 0.0) {
            if (origin[i] < -half[i] || origin[i] > half[i]) {
                return false;
            }
            continue;
        }
        double t1 = (-half[i] - origin[i]) / direction[i];
        double t2 = (half[i] - origin[i]) / direction[i];
        out->near = rlf_max(out->near, rlf_min(t1, t2));
        out->far = rlf_min(out->far, rlf_max(t1, t2));
    }
    return out->near <= out->far;
}

static bool intersect_sphere(double radius, rlf_vec3 o, rlf_vec3 d, synth_interval *out)
{
    return solve_quadratic(rlf_dot(d, d), rlf_dot(o, d), rlf_dot(o, o) - radius * radius, out);
}

/* The lateral surface of the hull of two spheres is rho cos(alpha) = radius_a - y sin(alpha) with
 * sin(alpha) = (radius_a - radius_b) / length, for 0 <= y - radius_a sin <= length cos^2. */
typedef struct cone_side {
    double sine, cosine2;
} cone_side;

static cone_side side_of(const synth_shape *shape)
{
    cone_side side;
    side.sine = (shape->radius_a - shape->radius_b) / shape->length;
    side.cosine2 = 1.0 - side.sine * side.sine;
    return side;
}

static void extend(synth_interval *interval, double t)
{
    interval->near = rlf_min(interval->near, t);
    interval->far = rlf_max(interval->far, t);
}

/* Every candidate lies in the solid, and entry and exit are candidates: the solid is convex, so
 * they are the smallest and the largest. */
static bool intersect_cone(const synth_shape *shape, rlf_vec3 o, rlf_vec3 d, synth_interval *out)
{
    synth_interval hit;
    out->near = FAR_AWAY;
    out->far = -FAR_AWAY;
    if (intersect_sphere(shape->radius_a, o, d, &hit)) {
        *out = hit;
    }
    rlf_vec3 o_b = rlf_vec3_make(o.x, o.y - shape->length, o.z);
    if (intersect_sphere(shape->radius_b, o_b, d, &hit)) {
        extend(out, hit.near);
        extend(out, hit.far);
    }
    cone_side side = side_of(shape);
    double k = shape->radius_a - side.sine * o.y;
    double a = side.cosine2 * (d.x * d.x + d.z * d.z) - side.sine * side.sine * d.y * d.y;
    double b = side.cosine2 * (o.x * d.x + o.z * d.z) + k * side.sine * d.y;
    double c = side.cosine2 * (o.x * o.x + o.z * o.z) - k * k;
    if (solve_quadratic(a, b, c, &hit)) {
        const double roots[2] = {hit.near, hit.far};
        for (int i = 0; i < 2; i++) {
            double y = o.y + roots[i] * d.y - shape->radius_a * side.sine;
            if (y >= 0.0 && y <= shape->length * side.cosine2) {
                extend(out, roots[i]);
            }
        }
    }
    return out->near <= out->far;
}

/* A disc across the axis at height y. */
static void extend_to_disc(synth_interval *out, rlf_vec3 o, rlf_vec3 d, double y, double radius)
{
    if (d.y != 0.0) {
        double t = (y - o.y) / d.y, px = o.x + t * d.x, pz = o.z + t * d.z;
        if (px * px + pz * pz <= radius * radius) {
            extend(out, t);
        }
    }
}

/* As for the round cone: entry and exit are among the crossings that lie in the solid. */
static bool intersect_frustum(const synth_shape *shape, rlf_vec3 o, rlf_vec3 d, synth_interval *out)
{
    synth_interval hit;
    double slope = (shape->radius_b - shape->radius_a) / shape->length;
    double radius = shape->radius_a + slope * o.y;
    double a = d.x * d.x + d.z * d.z - slope * slope * d.y * d.y;
    double b = o.x * d.x + o.z * d.z - slope * radius * d.y;
    double c = o.x * o.x + o.z * o.z - radius * radius;
    out->near = FAR_AWAY;
    out->far = -FAR_AWAY;
    extend_to_disc(out, o, d, 0.0, shape->radius_a);
    extend_to_disc(out, o, d, shape->length, shape->radius_b);
    if (solve_quadratic(a, b, c, &hit)) {
        const double roots[2] = {hit.near, hit.far};
        for (int i = 0; i < 2; i++) {
            double y = o.y + roots[i] * d.y;
            if (y >= 0.0 && y <= shape->length) {
                extend(out, roots[i]);
            }
        }
    }
    return out->near <= out->far;
}

static rlf_vec3 divide(rlf_vec3 a, rlf_vec3 b)
{
    return rlf_vec3_make(a.x / b.x, a.y / b.y, a.z / b.z);
}

bool synth_shape_meet(const synth_shape *shape, rlf_vec3 o, rlf_vec3 direction, synth_interval *out)
{
    const rlf_quat inverse = rlf_quat_conjugate(shape->T_camera_shape.q);
    const rlf_vec3 d = rlf_rotate(inverse, direction);
    switch (shape->type) {
    case SYNTH_HALF_SPACE: return intersect_half_space(o.y, d.y, out);
    case SYNTH_BOX: return intersect_box(shape->size, o, d, out);
    case SYNTH_CONE: return intersect_cone(shape, o, d, out);
    case SYNTH_FRUSTUM: return intersect_frustum(shape, o, d, out);
    default: return intersect_sphere(1.0, divide(o, shape->size), divide(d, shape->size), out);
    }
}

bool synth_shape_intersect(const synth_shape *shape, const synth_ray *ray, synth_interval *out)
{
    const rlf_vec3 o = rlf_transform_inverse(&shape->T_camera_shape, ray->origin);
    return synth_shape_meet(shape, o, ray->direction, out);
}

double synth_shape_bound(const synth_shape *shape, rlf_vec3 *out_centre)
{
    *out_centre = shape->T_camera_shape.p;
    switch (shape->type) {
    case SYNTH_BOX: return rlf_length(shape->size);
    case SYNTH_ELLIPSOID: return rlf_max(shape->size.x, rlf_max(shape->size.y, shape->size.z));
    case SYNTH_CONE: {
        double reach = 0.5 * (shape->length + shape->radius_a + shape->radius_b);
        double centre = reach - shape->radius_a;
        *out_centre = rlf_transform(&shape->T_camera_shape, rlf_vec3_make(0, centre, 0));
        return reach;
    }
    case SYNTH_FRUSTUM: {
        double half = 0.5 * shape->length, radius = rlf_max(shape->radius_a, shape->radius_b);
        *out_centre = rlf_transform(&shape->T_camera_shape, rlf_vec3_make(0, half, 0));
        return sqrt(half * half + radius * radius);
    }
    default: return FAR_AWAY;
    }
}
