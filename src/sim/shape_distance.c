/* Points against solids: signed distance, negative inside, and the normal at the nearest point. */
#include "sim/shape.h"

static double sign_of(double x)
{
    return x < 0.0 ? -1.0 : 1.0;
}

static double absolute(double x)
{
    return x < 0.0 ? -x : x;
}

/* Axis and depth of the face that an inner point is nearest to. */
static double nearest_face(rlf_vec3 size, rlf_vec3 p, rlf_vec3 *normal)
{
    double x = absolute(p.x) - size.x;
    double y = absolute(p.y) - size.y;
    double z = absolute(p.z) - size.z;
    if (x >= y && x >= z) {
        *normal = rlf_vec3_make(sign_of(p.x), 0, 0);
        return x;
    }
    if (y >= z) {
        *normal = rlf_vec3_make(0, sign_of(p.y), 0);
        return y;
    }
    *normal = rlf_vec3_make(0, 0, sign_of(p.z));
    return z;
}

static double distance_to_box(rlf_vec3 size, rlf_vec3 p, rlf_vec3 *normal)
{
    rlf_vec3 nearest = rlf_vec3_max(rlf_neg(size), rlf_vec3_min(size, p));
    rlf_vec3 outside = rlf_sub(p, nearest);
    double length = rlf_length(outside);
    if (length > 0.0) {
        *normal = rlf_scale(outside, 1.0 / length);
        return length;
    }
    return nearest_face(size, p, normal);
}

/* The sphere of the family along the axis that touches the hull nearest to p has its centre at
 * y - rho tan(alpha), clamped to the axis. */
static double distance_to_cone(const synth_shape *shape, rlf_vec3 p, rlf_vec3 *normal)
{
    double sine = (shape->radius_a - shape->radius_b) / shape->length;
    double rho = sqrt(p.x * p.x + p.z * p.z);
    double t = p.y - rho * sine / sqrt(1.0 - sine * sine);
    t = rlf_clamp(t, 0.0, shape->length);
    double radius = shape->radius_a - sine * t;
    rlf_vec3 offset = rlf_vec3_make(p.x, p.y - t, p.z);
    double length = rlf_length(offset);
    *normal = length > 0.0 ? rlf_scale(offset, 1.0 / length) : rlf_vec3_make(1, 0, 0);
    return length - radius;
}

#define ON_SURFACE 1e-12 /* metres: the way to the nearest point says nothing of the normal */

/* In the half plane through the axis and p: distance along the axis and across it. */
typedef struct half_plane {
    double rho, y;
} half_plane;

static half_plane to_segment(half_plane p, half_plane a, half_plane b)
{
    double dr = b.rho - a.rho, dy = b.y - a.y;
    double share = ((p.rho - a.rho) * dr + (p.y - a.y) * dy) / (dr * dr + dy * dy);
    share = rlf_clamp(share, 0.0, 1.0);
    return (half_plane){p.rho - a.rho - share * dr, p.y - a.y - share * dy};
}

/* Of the face whose plane p is farthest outside of, or least inside. */
static double frustum_face(const synth_shape *shape, half_plane p, half_plane *normal)
{
    double rise = shape->radius_b - shape->radius_a;
    double slant = sqrt(rise * rise + shape->length * shape->length);
    const half_plane normals[3] = {{0, -1}, {0, 1}, {shape->length / slant, -rise / slant}};
    const double off[3] = {-p.y, p.y - shape->length,
                           (p.rho - shape->radius_a) * normals[2].rho + p.y * normals[2].y};
    int face = off[1] > off[0] ? 1 : 0;
    face = off[2] > off[face] ? 2 : face;
    *normal = normals[face];
    return off[face];
}

static double distance_to_frustum(const synth_shape *shape, rlf_vec3 p, rlf_vec3 *normal)
{
    const half_plane corners[4] = {
        {0, 0}, {shape->radius_a, 0}, {shape->radius_b, shape->length}, {0, shape->length}};
    half_plane at = {sqrt(p.x * p.x + p.z * p.z), p.y}, n;
    double distance = frustum_face(shape, at, &n);
    const half_plane face = n;
    if (distance > 0.0) {
        distance = 1e9;
        for (int i = 0; i < 3; i++) {
            half_plane off = to_segment(at, corners[i], corners[i + 1]);
            double length = sqrt(off.rho * off.rho + off.y * off.y);
            if (length < distance) {
                distance = length;
                n = length > ON_SURFACE ? (half_plane){off.rho / length, off.y / length} : face;
            }
        }
    }
    double x = at.rho > 0.0 ? p.x / at.rho : 1.0, z = at.rho > 0.0 ? p.z / at.rho : 0.0;
    *normal = rlf_vec3_make(n.rho * x, n.y, n.rho * z);
    return distance;
}

/* On the surface or very near to it. */
static rlf_vec3 frustum_normal(const synth_shape *shape, rlf_vec3 p)
{
    half_plane at = {sqrt(p.x * p.x + p.z * p.z), p.y}, n;
    (void)frustum_face(shape, at, &n);
    double scale = at.rho > 0.0 ? n.rho / at.rho : 0.0;
    return rlf_vec3_make(p.x * scale, n.y, p.z * scale);
}

/* Nearest point of an ellipsoid (Eberly, "Distance from a point to an ellipsoid"): x_i = e_i^2 p_i
 * / (s + e_i^2), where s is the largest root of sum (e_i p_i / (s + e_i^2))^2 = 1. The sum is
 * convex and falls for s > -min e^2, so Newton from the left end climbs to the root; a bisection
 * step replaces it where it would leave the bracket. */
static double ellipsoid_root(const double e2[3], const double p2[3])
{
    double smallest = rlf_min(e2[0], rlf_min(e2[1], e2[2]));
    double largest = rlf_max(e2[0], rlf_max(e2[1], e2[2]));
    double low = -smallest;
    double high = sqrt(largest * (p2[0] + p2[1] + p2[2])) + smallest;
    double s = rlf_max(0.0, low);
    for (int iteration = 0; iteration < 80; iteration++) {
        double value = -1.0;
        double slope = 0.0;
        for (int i = 0; i < 3; i++) {
            double d = s + e2[i];
            double term = e2[i] * p2[i] / (d * d);
            value += term;
            slope -= 2.0 * term / d;
        }
        if (value > 0.0) {
            low = s;
        } else {
            high = s;
        }
        double next = slope < 0.0 ? s - value / slope : low;
        if (!(next > low && next < high)) {
            next = 0.5 * (low + high);
        }
        if (absolute(next - s) <= 1e-16 * largest) {
            return next;
        }
        s = next;
    }
    return s;
}

static double distance_to_ellipsoid(rlf_vec3 size, rlf_vec3 p, rlf_vec3 *normal)
{
    const double e2[3] = {size.x * size.x, size.y * size.y, size.z * size.z};
    /* On a symmetry plane the inner nearest point is not unique; a nanometre picks one of them. */
    const double q[3] = {absolute(p.x) + 1e-9, absolute(p.y) + 1e-9, absolute(p.z) + 1e-9};
    const double p2[3] = {q[0] * q[0], q[1] * q[1], q[2] * q[2]};
    double s = ellipsoid_root(e2, p2);
    rlf_vec3 n = rlf_vec3_make(q[0] / (s + e2[0]), q[1] / (s + e2[1]), q[2] / (s + e2[2]));
    rlf_vec3 nearest = rlf_vec3_make(e2[0] * n.x, e2[1] * n.y, e2[2] * n.z);
    /* The root's rounding error, magnified where s is close to -e^2, must not leave the surface. */
    double level = e2[0] * n.x * n.x + e2[1] * n.y * n.y + e2[2] * n.z * n.z;
    nearest = rlf_scale(nearest, 1.0 / sqrt(level));
    double length = rlf_length(rlf_sub(rlf_vec3_make(q[0], q[1], q[2]), nearest));
    n = rlf_normalize(n);
    *normal = rlf_vec3_make(sign_of(p.x) * n.x, sign_of(p.y) * n.y, sign_of(p.z) * n.z);
    return s < 0.0 ? -length : length;
}

/* In the shape's frame. */
static double distance_to(const synth_shape *shape, rlf_vec3 local, rlf_vec3 *normal)
{
    switch (shape->type) {
    case SYNTH_HALF_SPACE: *normal = rlf_vec3_make(0, -1, 0); return -local.y;
    case SYNTH_BOX: return distance_to_box(shape->size, local, normal);
    case SYNTH_CONE: return distance_to_cone(shape, local, normal);
    case SYNTH_FRUSTUM: return distance_to_frustum(shape, local, normal);
    default: return distance_to_ellipsoid(shape->size, local, normal);
    }
}

double synth_shape_distance(const synth_shape *shape, rlf_vec3 p, rlf_vec3 *out_normal)
{
    const rlf_vec3 local = rlf_transform_inverse(&shape->T_camera_shape, p);
    rlf_vec3 normal;
    const double distance = distance_to(shape, local, &normal);
    *out_normal = rlf_rotate(shape->T_camera_shape.q, normal);
    return distance;
}

double synth_shape_gap(const synth_shape *shape, rlf_vec3 p)
{
    rlf_vec3 normal;
    return distance_to(shape, rlf_transform_inverse(&shape->T_camera_shape, p), &normal);
}

rlf_vec3 synth_shape_normal(const synth_shape *shape, rlf_vec3 p)
{
    rlf_vec3 local = rlf_transform_inverse(&shape->T_camera_shape, p);
    rlf_vec3 normal = rlf_vec3_make(0, -1, 0);
    rlf_vec3 size = shape->size;
    switch (shape->type) {
    case SYNTH_HALF_SPACE: break;
    case SYNTH_BOX: (void)nearest_face(size, local, &normal); break;
    case SYNTH_CONE: (void)distance_to_cone(shape, local, &normal); break;
    case SYNTH_FRUSTUM: normal = frustum_normal(shape, local); break;
    default:
        normal = rlf_normalize(rlf_vec3_make(
            local.x / (size.x * size.x), local.y / (size.y * size.y), local.z / (size.z * size.z)));
        break;
    }
    return rlf_rotate(shape->T_camera_shape.q, normal);
}
