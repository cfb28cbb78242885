/* Farthest points of the shapes' cores: the support mapping. */
#include "physics/shape/convex.h"
#include "physics/shape/shape.h"

static rlf_vec3 farthest_of_hull(const rlf_hull *hull, rlf_vec3 d)
{
    int32_t best = 0;
    double most = rlf_dot(hull->vertices[0], d);
    for (int32_t i = 1; i < hull->vertex_count; i++) {
        double along = rlf_dot(hull->vertices[i], d);
        if (along > most) {
            most = along;
            best = i;
        }
    }
    return hull->vertices[best];
}

static double with_sign(double size, double like)
{
    return like < 0.0 ? -size : size;
}

double convex_rounding(const rlf_shape *shape)
{
    bool is_round = shape->type == RLF_SHAPE_SPHERE || shape->type == RLF_SHAPE_CAPSULE;
    return is_round ? shape->radius : 0.0;
}

rlf_vec3 convex_farthest(const rlf_shape *s, rlf_vec3 d)
{
    double half = 0.5 * s->height;
    switch (s->type) {
    case RLF_SHAPE_BOX:
        return rlf_vec3_make(with_sign(0.5 * s->size.x, d.x), with_sign(0.5 * s->size.y, d.y),
                             with_sign(0.5 * s->size.z, d.z));
    case RLF_SHAPE_SPHERE: break;
    case RLF_SHAPE_CAPSULE: return rlf_vec3_make(0, with_sign(half, d.y), 0);
    case RLF_SHAPE_CYLINDER: {
        rlf_vec3 rim = rlf_scale(rlf_normalize(rlf_vec3_make(d.x, 0, d.z)), s->radius);
        return rlf_add(rim, rlf_vec3_make(0, with_sign(half, d.y), 0));
    }
    case RLF_SHAPE_HULL: return farthest_of_hull(s->hull, d);
    }
    return rlf_vec3_make(0, 0, 0);
}

static rlf_vec3 farthest_of_core(const convex_core *core, rlf_vec3 d)
{
    rlf_vec3 local = convex_farthest(core->shape, phys_to_frame(&core->R, d));
    return rlf_add(core->at, rlf_mat3_mul_vec(&core->R, local));
}

convex_corner convex_difference(const convex_core *a, const convex_core *b, rlf_vec3 d)
{
    convex_corner corner = {farthest_of_core(a, d), farthest_of_core(b, rlf_neg(d)), {0, 0, 0}};
    corner.p = rlf_sub(corner.on_a, corner.on_b);
    return corner;
}
