/* Do two convex shapes overlap? Exact for all shapes up to TOUCH. */
#include "relief/query.h"

#include "physics/shape/convex.h"
#include "physics/shape/shape.h"

#define TOUCH 1e-7 /* m, of shapes of about a metre */

static bool meet(const rlf_shape *a, const rlf_pose *T_world_a, const rlf_shape *b,
                 const rlf_pose *T_world_b)
{
    const convex_core one = {a, rlf_quat_to_mat3(T_world_a->q), {0, 0, 0}};
    const convex_core two = {b, rlf_quat_to_mat3(T_world_b->q),
                             rlf_sub(T_world_b->p, T_world_a->p)};
    double limit = convex_rounding(a) + convex_rounding(b) + TOUCH;
    convex_gap gap;
    convex_simplex simplex;
    return !convex_distance(&one, &two, limit, &gap, &simplex) || gap.distance <= limit;
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
    return meet(a, T_world_a, b, T_world_b) ? RLF_QUERY_HIT : RLF_QUERY_MISS;
}
