/* Collision between bodies: the vertex feature only, as the thesis has it. */
#include "physics/thesis/thesis.h"

/* a's vertices inside b: an impulse along the normal of b's nearest face. */
static void vertices_against(rlf_world *world, int32_t a_index, int32_t b_index)
{
    phys_body *a = &world->bodies[a_index];
    phys_body *b = &world->bodies[b_index];
    rlf_pose T_world_b = phys_body_pose(b);
    rlf_pose T_world_a = phys_body_pose(a);
    double restitution = rlf_max(a->restitution, b->restitution);
    for (int32_t i = 0; i < a->shape.vertex_count; i++) {
        rlf_vec3 p = rlf_transform(&T_world_a, a->shape.points[i]);
        rlf_vec3 gradient;
        double distance =
            phys_shape_distance(&b->shape, rlf_transform_inverse(&T_world_b, p), &gradient);
        if (distance > 0.0) {
            continue;
        }
        rlf_vec3 n = rlf_rotate(b->q, gradient);
        rlf_vec3 r_a = rlf_sub(p, a->x);
        rlf_vec3 r_b = rlf_sub(p, b->x);
        double approach =
            -rlf_dot(n, rlf_sub(phys_body_velocity_at(a, r_a), phys_body_velocity_at(b, r_b)));
        double j = thesis_impulse(a, b, p, n, restitution);
        if (j > 0.0) {
            phys_contact contact = {.a = a_index, .b = b_index, .log = -1, .met = phys_narrow(p)};
            contact.met_normal = phys_narrow(n);
            contact.separation = distance;
            contact.impulse_sum = j;
            contact.approach = approach;
            phys_log_impulse(world, &contact);
        }
    }
}

/* Balls have no vertices: exact centres. */
static bool collide_balls(rlf_world *world, int32_t a_index, int32_t b_index)
{
    phys_body *a = &world->bodies[a_index];
    phys_body *b = &world->bodies[b_index];
    if (a->shape.shape.type != RLF_SHAPE_SPHERE || b->shape.shape.type != RLF_SHAPE_SPHERE) {
        return false;
    }
    rlf_vec3 n = rlf_normalize(rlf_sub(a->x, b->x));
    rlf_vec3 p = rlf_mad(b->x, n, b->shape.radius);
    double approach = -rlf_dot(n, rlf_sub(a->v, b->v));
    double j = thesis_impulse(a, b, p, n, rlf_max(a->restitution, b->restitution));
    if (j > 0.0) {
        phys_contact contact = {.a = a_index, .b = b_index, .log = -1, .met = phys_narrow(p)};
        contact.met_normal = phys_narrow(n);
        contact.separation = rlf_length(rlf_sub(a->x, b->x)) - a->shape.radius - b->shape.radius;
        contact.impulse_sum = j;
        contact.approach = approach;
        phys_log_impulse(world, &contact);
    }
    return true;
}

void thesis_collide_bodies(rlf_world *world)
{
    for (int32_t i = 0; i < world->body_top; i++) {
        const phys_body *a = &world->bodies[i];
        for (int32_t k = i + 1; a->is_alive && k < world->body_top; k++) {
            const phys_body *b = &world->bodies[k];
            double reach = a->shape.radius + b->shape.radius;
            rlf_vec3 d = rlf_sub(a->x, b->x);
            if (!b->is_alive || !a->collides_with_bodies || !b->collides_with_bodies ||
                rlf_dot(d, d) > reach * reach || collide_balls(world, i, k)) {
                continue;
            }
            vertices_against(world, i, k);
            vertices_against(world, k, i);
        }
    }
}
