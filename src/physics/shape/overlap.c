/* Do two convex shapes overlap? Gilbert, Johnson and Keerthi 1988: the origin is searched in the
 * difference of the shapes, whose farthest points are differences of theirs. Exact for all shapes
 * up to TOUCH. */
#include "relief/query.h"

#include "physics/shape/shape.h"

#define STEPS_MAX 64
#define TOUCH 1e-7 /* m, of shapes of about a metre */

typedef struct placed_shape {
    const rlf_shape *shape;
    const rlf_pose *T_world_shape;
} placed_shape;

static rlf_vec3 farthest_of_hull(const rlf_hull *hull, rlf_vec3 d)
{
    int32_t best = 0;
    for (int32_t i = 1; i < hull->vertex_count; i++) {
        best = rlf_dot(hull->vertices[i], d) > rlf_dot(hull->vertices[best], d) ? i : best;
    }
    return hull->vertices[best];
}

static double with_sign(double size, double like)
{
    return like < 0.0 ? -size : size;
}

/* Point of the shape that is farthest along d, shape frame. */
static rlf_vec3 farthest(const rlf_shape *s, rlf_vec3 d)
{
    double half = 0.5 * s->height;
    switch (s->type) {
    case RLF_SHAPE_BOX:
        return rlf_vec3_make(with_sign(0.5 * s->size.x, d.x), with_sign(0.5 * s->size.y, d.y),
                             with_sign(0.5 * s->size.z, d.z));
    case RLF_SHAPE_SPHERE: return rlf_scale(rlf_normalize(d), s->radius);
    case RLF_SHAPE_CAPSULE: {
        rlf_vec3 cap = rlf_scale(rlf_normalize(d), s->radius);
        return rlf_add(cap, rlf_vec3_make(0, with_sign(half, d.y), 0));
    }
    case RLF_SHAPE_CYLINDER: {
        rlf_vec3 rim = rlf_scale(rlf_normalize(rlf_vec3_make(d.x, 0, d.z)), s->radius);
        return rlf_add(rim, rlf_vec3_make(0, with_sign(half, d.y), 0));
    }
    case RLF_SHAPE_HULL: return farthest_of_hull(s->hull, d);
    }
    return rlf_vec3_make(0, 0, 0);
}

static rlf_vec3 farthest_in_world(const placed_shape *s, rlf_vec3 d)
{
    rlf_vec3 local = rlf_rotate(rlf_quat_conjugate(s->T_world_shape->q), d);
    return rlf_transform(s->T_world_shape, farthest(s->shape, local));
}

/* Corners of the difference around which the origin is searched, the newest first. */
typedef struct simplex {
    rlf_vec3 p[4];
    int32_t count;
} simplex;

/* Each of these keeps the part of the simplex that is nearest to the origin and returns the
 * direction from it towards the origin; the zero vector when the origin is on it. */
static rlf_vec3 from_edge(simplex *s)
{
    rlf_vec3 ab = rlf_sub(s->p[1], s->p[0]), ao = rlf_neg(s->p[0]);
    if (rlf_dot(ab, ao) <= 0.0) {
        s->count = 1;
        return ao;
    }
    return rlf_cross(rlf_cross(ab, ao), ab);
}

static rlf_vec3 from_two(simplex *s, int32_t i, int32_t k)
{
    const simplex edge = {{s->p[i], s->p[k]}, 2};
    *s = edge;
    return from_edge(s);
}

static rlf_vec3 from_triangle(simplex *s)
{
    rlf_vec3 ab = rlf_sub(s->p[1], s->p[0]), ac = rlf_sub(s->p[2], s->p[0]);
    rlf_vec3 ao = rlf_neg(s->p[0]), n = rlf_cross(ab, ac);
    bool is_past_ac = rlf_dot(rlf_cross(n, ac), ao) > 0.0;
    bool is_past_ab = rlf_dot(rlf_cross(ab, n), ao) > 0.0;
    if (is_past_ac && rlf_dot(ac, ao) > 0.0) {
        return from_two(s, 0, 2);
    }
    if (is_past_ac || is_past_ab) {
        return from_two(s, 0, 1);
    }
    if (rlf_dot(n, ao) < 0.0) { /* the corners run around the side of the origin */
        rlf_vec3 swap = s->p[1];
        s->p[1] = s->p[2];
        s->p[2] = swap;
        return rlf_neg(n);
    }
    return rlf_dot(n, ao) > 0.0 ? n : rlf_vec3_make(0, 0, 0);
}

static rlf_vec3 from_tetrahedron(simplex *s)
{
    const int32_t FACES[3][2] = {{1, 2}, {2, 3}, {3, 1}};
    for (int32_t i = 0; i < 3; i++) {
        rlf_vec3 b = s->p[FACES[i][0]], c = s->p[FACES[i][1]];
        rlf_vec3 n = rlf_cross(rlf_sub(b, s->p[0]), rlf_sub(c, s->p[0]));
        if (rlf_dot(n, s->p[0]) < 0.0) {
            const simplex face = {{s->p[0], b, c}, 3};
            *s = face;
            return from_triangle(s);
        }
    }
    return rlf_vec3_make(0, 0, 0);
}

static rlf_vec3 next_direction(simplex *s)
{
    switch (s->count) {
    case 1: return rlf_neg(s->p[0]);
    case 2: return from_edge(s);
    case 3: return from_triangle(s);
    default: return from_tetrahedron(s);
    }
}

static bool meet(const placed_shape *a, const placed_shape *b)
{
    rlf_vec3 d = rlf_sub(b->T_world_shape->p, a->T_world_shape->p);
    d = rlf_dot(d, d) > 0.0 ? d : rlf_vec3_make(1, 0, 0);
    simplex s = {.count = 0};
    for (int32_t i = 0; i < STEPS_MAX; i++) {
        rlf_vec3 p = rlf_sub(farthest_in_world(a, d), farthest_in_world(b, rlf_neg(d)));
        if (rlf_dot(p, d) < -TOUCH * rlf_length(d)) {
            return false; /* the whole difference is on this side of the origin */
        }
        for (int32_t k = s.count; k > 0; k--) {
            s.p[k] = s.p[k - 1];
        }
        s.p[0] = p;
        s.count++;
        d = next_direction(&s);
        double length = rlf_length(d);
        if (!(length > 1e-30)) {
            return true;
        }
        d = rlf_scale(d, 1.0 / length);
    }
    return true; /* they touch to within rounding */
}

static bool is_good(const rlf_shape *shape, const rlf_pose *T)
{
    return rlf_vec3_is_finite(T->p) && rlf_is_finite(T->q.x + T->q.y + T->q.z + T->q.w) &&
           phys_shape_check(shape) == RLF_OK;
}

rlf_query_reason rlf_shapes_overlap(const rlf_shape *a, const rlf_pose *T_world_a,
                                    const rlf_shape *b, const rlf_pose *T_world_b)
{
    if (!RLF_ASSERT(a != NULL && T_world_a != NULL && b != NULL && T_world_b != NULL) ||
        !is_good(a, T_world_a) || !is_good(b, T_world_b)) {
        return RLF_QUERY_INVALID;
    }
    const placed_shape one = {a, T_world_a}, two = {b, T_world_b};
    return meet(&one, &two) ? RLF_QUERY_HIT : RLF_QUERY_MISS;
}
