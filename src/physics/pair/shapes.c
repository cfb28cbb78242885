/* Balls against anything and capsules against each other: points of their cores, with a rounding,
 * in the signed distance of the other, which is exact. */
#include "physics/pair/collide.h"

#define CAPSULE_POINTS 5

/* Core points of a ball or a capsule; returns their number. */
static int32_t core_points(const rlf_shape *shape, rlf_vec3 out[CAPSULE_POINTS])
{
    int32_t count = shape->type == RLF_SHAPE_CAPSULE ? CAPSULE_POINTS : 1;
    for (int32_t i = 0; i < count; i++) {
        double place = count > 1 ? (double)i / (count - 1) - 0.5 : 0.0;
        out[i] = rlf_vec3_make(0, shape->height * place, 0);
    }
    return count;
}

static int32_t points_against(const phys_body *a, const phys_body *b, double margin,
                              bool is_swapped, pair_point *out)
{
    rlf_vec3 points[CAPSULE_POINTS];
    double rounding = a->shape.shape.radius;
    int32_t count = core_points(&a->shape.shape, points);
    rlf_pose T_world_a = phys_body_pose(a), T_world_b = phys_body_pose(b);
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = rlf_transform(&T_world_a, points[i]);
        rlf_vec3 gradient;
        rlf_vec3 local = rlf_transform_inverse(&T_world_b, p);
        double distance = phys_shape_distance(&b->shape, local, &gradient);
        if (distance - rounding > margin) {
            continue;
        }
        rlf_vec3 on_b = rlf_transform(&T_world_b, rlf_mad(local, gradient, -distance));
        rlf_vec3 n = rlf_rotate(b->q, gradient);
        pair_point *hit = &out[kept++];
        hit->core_a = is_swapped ? on_b : p;
        hit->core_b = is_swapped ? p : on_b;
        hit->rounding_a = is_swapped ? 0.0 : rounding;
        hit->rounding_b = is_swapped ? rounding : 0.0;
        hit->normal = is_swapped ? rlf_neg(n) : n;
        hit->separation = distance - rounding;
    }
    return kept;
}

/* Closest points of two segments centre +- half axis (Ericson 2005, 5.1.9). */
static int32_t crossed_capsules(const phys_body *a, const phys_body *b, double margin,
                                pair_point *out)
{
    rlf_vec3 u = rlf_rotate(a->q, rlf_vec3_make(0, 1, 0));
    rlf_vec3 v = rlf_rotate(b->q, rlf_vec3_make(0, 1, 0));
    double half_a = 0.5 * a->shape.shape.height, half_b = 0.5 * b->shape.shape.height;
    rlf_vec3 d = rlf_sub(a->x, b->x);
    double uv = rlf_dot(u, v), ud = rlf_dot(u, d), vd = rlf_dot(v, d);
    double determinant = 1.0 - uv * uv;
    double s = determinant > 1e-9 ? (uv * vd - ud) / determinant : 0.0;
    s = rlf_clamp(s, -half_a, half_a);
    double t = rlf_clamp(vd + uv * s, -half_b, half_b);
    s = rlf_clamp(uv * t - ud, -half_a, half_a);
    out->core_a = rlf_mad(a->x, u, s);
    out->core_b = rlf_mad(b->x, v, t);
    rlf_vec3 between = rlf_sub(out->core_a, out->core_b);
    double length = rlf_length(between);
    out->rounding_a = a->shape.shape.radius;
    out->rounding_b = b->shape.shape.radius;
    out->normal = length > 1e-9 ? rlf_scale(between, 1.0 / length) : rlf_perpendicular(u);
    out->separation = length - out->rounding_a - out->rounding_b;
    return out->separation <= margin ? 1 : 0;
}

int32_t pair_collide_shapes(const phys_body *a, const phys_body *b, double margin, pair_point *out,
                            double *out_gap)
{
    rlf_shape_type type_a = a->shape.shape.type, type_b = b->shape.shape.type;
    if (type_a == RLF_SHAPE_SPHERE) {
        return points_against(a, b, margin, false, out);
    }
    if (type_b == RLF_SHAPE_SPHERE) {
        return points_against(b, a, margin, true, out);
    }
    if (type_a != RLF_SHAPE_CAPSULE || type_b != RLF_SHAPE_CAPSULE) {
        return pair_collide_convex(a, b, margin, out, out_gap);
    }
    int32_t count = points_against(a, b, margin, false, out);
    count += points_against(b, a, margin, true, out + count);
    return count + crossed_capsules(a, b, margin, out + count);
}

int32_t pair_reduce(const pair_point *points, int32_t count, double radius,
                    int32_t chosen[PHYS_PAIR_CONTACTS])
{
    bool is_used[PAIR_POINTS_MAX] = {false};
    int32_t kept = 0;
    while (kept < PHYS_PAIR_CONTACTS) {
        int32_t best = -1;
        double best_value = -1e30;
        for (int32_t i = 0; i < count; i++) {
            double nearest2 = 1e60; /* square of the distance to those already chosen */
            for (int32_t k = 0; k < kept && !is_used[i]; k++) {
                rlf_vec3 d = rlf_sub(points[i].core_a, points[chosen[k]].core_a);
                nearest2 = rlf_min(nearest2, rlf_dot(d, d));
            }
            double nearest = sqrt(nearest2);
            bool is_like = kept == 0 || rlf_dot(points[i].normal, points[chosen[0]].normal) > 0.9;
            if (is_used[i] || !is_like || nearest < 0.02 * radius) {
                continue;
            }
            /* first the deepest, then far from the chosen, but rather touching than not */
            double value = kept == 0 ? -points[i].separation
                                     : nearest - 2.0 * rlf_max(points[i].separation, 0.0);
            if (value > best_value) {
                best_value = value;
                best = i;
            }
        }
        if (best < 0) {
            break;
        }
        is_used[best] = true;
        chosen[kept++] = best;
    }
    return kept;
}
