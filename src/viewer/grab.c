/* A body held by the mouse. */
#include "viewer/mouse.h"

#define RATE 18.0        /* 1/s: the spring comes to rest in about two of these */
#define ACCELERATION 200 /* m/s^2 at most */
#define REACH_MIN_M 0.2
#define ARM_M 0.1 /* of the two forces that stop the spin */

static const rlf_body_state *find_body(const rlf_world *world, rlf_body_id id)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    for (int32_t i = 0; i < s->body_count; i++) {
        if (s->bodies[i].id.index1 == id.index1 && s->bodies[i].id.generation == id.generation) {
            return &s->bodies[i];
        }
    }
    return NULL;
}

bool viewer_grab_find(const rlf_world *world, const viewer_ray *ray, rlf_ray_hit *out)
{
    *out = rlf_world_cast_ray(world, NULL, ray->origin, ray->direction, VIEWER_GRAB_REACH_M);
    return out->reason == RLF_QUERY_HIT && find_body(world, out->body) != NULL;
}

void viewer_grab_begin(viewer_grab *grab, const rlf_world *world, const viewer_ray *ray,
                       const rlf_ray_hit *hit)
{
    const rlf_body_state *body = find_body(world, hit->body);
    *grab = (viewer_grab){.is_on = body != NULL, .id = hit->body, .distance = hit->distance};
    grab->ray = *ray;
    if (body != NULL) {
        grab->offset = rlf_sub(body->T_world_body.p, hit->point);
    }
}

void viewer_grab_reach(viewer_grab *grab, double steps)
{
    grab->distance =
        rlf_clamp(grab->distance * (1.0 - 0.1 * steps), REACH_MIN_M, VIEWER_GRAB_REACH_M);
}

/* Two forces that are opposite to each other: they turn, and do not move. */
static void twist(rlf_world *world, const rlf_body_state *body, rlf_vec3 torque)
{
    const rlf_vec3 x = rlf_vec3_make(1, 0, 0);
    const rlf_vec3 y = rlf_vec3_make(0, 1, 0);
    const rlf_vec3 across = rlf_cross(torque, torque.x * torque.x > torque.y * torque.y ? y : x);
    if (!(rlf_length(across) > 0.0)) {
        return;
    }
    const rlf_vec3 arm = rlf_scale(rlf_normalize(across), ARM_M);
    const rlf_vec3 force = rlf_scale(rlf_cross(torque, arm), 0.5 / (ARM_M * ARM_M));
    const rlf_vec3 p = body->T_world_body.p;
    rlf_world_apply_force(world, body->id, force, rlf_add(p, arm));
    rlf_world_apply_force(world, body->id, rlf_neg(force), rlf_sub(p, arm));
}

void viewer_grab_pull(viewer_grab *grab, rlf_world *world, double dt)
{
    const rlf_body_state *body = grab->is_on ? find_body(world, grab->id) : NULL;
    grab->is_on = body != NULL;
    if (body == NULL || !(dt > 0.0)) {
        return;
    }
    const rlf_vec3 p = rlf_mad(grab->ray.origin, grab->ray.direction, grab->distance);
    const rlf_vec3 way = rlf_sub(rlf_add(p, grab->offset), body->T_world_body.p);
    /* The critically damped spring's velocity at the end of the step, taken implicitly, so that no
     * step is too long for it. Source: Baraff and Witkin 1998. */
    const double k = RATE * RATE * dt;
    const rlf_vec3 v =
        rlf_scale(rlf_mad(body->velocity, way, k), 1.0 / (1.0 + 2.0 * RATE * dt + k * dt));
    rlf_vec3 a = rlf_scale(rlf_sub(v, body->velocity), 1.0 / dt);
    a = rlf_sub(a, rlf_world_get_snapshot(world)->gravity);
    const double most = ACCELERATION / rlf_max(rlf_length(a), ACCELERATION);
    rlf_world_apply_force(world, body->id, rlf_scale(a, most * body->mass), body->T_world_body.p);
    const rlf_mat3 inertia = rlf_shape_inertia(&body->shape, body->mass);
    const double mean = (inertia.m[0][0] + inertia.m[1][1] + inertia.m[2][2]) / 3.0;
    const double damping = 2.0 * RATE / (1.0 + 2.0 * RATE * dt);
    twist(world, body, rlf_scale(body->angular_velocity, -damping * mean));
}
