/* A rigid body's state and its contacts. Shared by all files of this module. */
#ifndef RLF_PHYSICS_BODY_H
#define RLF_PHYSICS_BODY_H

#include "physics/contact.h"
#include "physics/shape/shape.h"

/* What a part of a substep reads lies side by side: lines of memory begin where bodies do, and no
 * crowd fits in a processor's second cache. See fetch.h. */
typedef struct phys_body {
    _Alignas(64) rlf_vec3 v; /* of the centre of mass, world */
    rlf_vec3 w;              /* angular, world */
    double inverse_mass;     /* 0 while held, and of a kinematic body */
    double speed;            /* no point of it was faster at the start of the substep, m/s */

    rlf_vec3 acceleration, angular_acceleration;
    double pull;                        /* length of the acceleration, m/s^2 */
    double impact_time;                 /* of its last bounce in this substep, s */
    rlf_vec3 impact_shift, impact_turn; /* x and orientation jump so that x(t) = x + shift + v t */
    bool is_alive, is_held, is_asleep, collides_with_bodies;
    bool is_kinematic;   /* not held: moves by v and w, and nothing changes them */
    bool is_real;        /* a model of a real thing */
    bool is_isotropic;   /* inertia is a multiple of 1 */
    bool is_pressed;     /* a contact held it in this substep */
    bool was_pressed;    /* ... in the last one */
    bool is_restless;    /* a bounce turned its way: its contacts are to be searched again */
    uint32_t generation; /* of the handle; counts up when a body goes */

    rlf_vec3 x; /* centre of mass, world */
    rlf_quat q;
    double turned; /* radians, all turns added up */
    rlf_mat3 R;    /* of q; the thesis method integrates R itself */

    rlf_vec3 surface_x;   /* where it was when its contacts with the surface were searched */
    double surface_clear; /* m that it may move from there before it touches; 0: it may touch, or it
                             is not known */
    int32_t surface_age, surface_period; /* substeps since, and between, surface queries */
    int32_t surface_count;
    phys_contact *surface; /* PHYS_SURFACE_CONTACTS */

    rlf_vec3 force, torque;                 /* from the caller, for the next advance */
    double linear_damping, angular_damping; /* 1/s */

    rlf_mat3 inverse_inertia_world; /* 0 while held, and of a kinematic body */
    double rolling_resistance;
    double restitution, friction;
    double mass, gravity_scale;
    phys_shape shape;
    phys_stance stance; /* on the surface */

    double release_time;
    rlf_mat3 inertia, inverse_inertia; /* body frame */
    rlf_vec3 momentum, momentum_w;     /* angular momentum that goes with momentum_w, momentum_q */
    rlf_quat momentum_q;
    rlf_vec3 throw_v, throw_w; /* velocities to start with when a held body is released */

    double still_time; /* s it has stayed in place */
    rlf_vec3 still_x;
    rlf_quat still_q;
    rlf_vec3 block_sum, block_mean; /* of x - still_x, over blocks of time; see sleep.c */
    double block_time;
    bool has_block;
    int64_t rest_version; /* of the surface that its contacts of this sleep are with; 0 = none */
    bool has_left;        /* it left the place where it rested, in the last look */
    bool is_disturbed;    /* it touches something restless */

    double surface_time;           /* world time of the last surface query, s */
    double surface_turned;         /* how far it had turned then ... */
    int64_t surface_version;       /* ... and what stays, 0 = something moved near it */
    rlf_vec3 surface_v, surface_w; /* v and w then */
    rlf_vec3 surface_flow;         /* velocity of the foreground near it, grid frame */
    /* field_state: which side of each camera's foreground and background it belongs to */
    uint8_t side[RLF_WORLD_CAMERAS_MAX][2];

    struct phys_grab *grab; /* the hand that holds it, or NULL; see grab/grab.h */
    double soft_until;      /* s of the world: until then hands do not push it, they close on it */
    int32_t grip_frames;    /* in which pixels gripped it */
    uint32_t grasp_votes;   /* bit k: k frames ago a hand grasped it */
    double free_until;      /* s of the world: until then it is not grabbed again */

    char name[RLF_NAME_MAX];
    float color[3];
    rlf_look look;
} phys_body;

/* Recomputes R and the world inertia from q. */
static inline void phys_body_orient(phys_body *body)
{
    body->R = rlf_quat_to_mat3(body->q);
    if (body->inverse_mass == 0.0) {
        body->inverse_inertia_world = rlf_mat3_diagonal(0, 0, 0);
        return;
    }
    if (body->is_isotropic) {
        body->inverse_inertia_world = body->inverse_inertia;
        return;
    }
    rlf_mat3 half = rlf_mat3_mul(&body->R, &body->inverse_inertia);
    rlf_mat3 transposed = rlf_mat3_transpose(&body->R);
    body->inverse_inertia_world = rlf_mat3_mul(&half, &transposed);
}

/* The same after a turn: the inertia of what turns like a ball stays as it is. */
static inline void phys_body_reorient(phys_body *body)
{
    if (body->is_isotropic && body->inverse_mass > 0.0) {
        body->R = rlf_quat_to_mat3(body->q);
    } else {
        phys_body_orient(body);
    }
}

/* Its contacts with the surface are to be searched in the next substep. */
static inline void phys_body_ask_surface(phys_body *body)
{
    body->surface_clear = 0.0;
    body->surface_age = body->surface_period;
}

/* Nothing of the surface is where it is now, however it turns. */
static inline bool phys_body_is_clear(const phys_body *body)
{
    rlf_vec3 moved = rlf_sub(body->x, body->surface_x);
    return rlf_dot(moved, moved) < body->surface_clear * body->surface_clear;
}

/* The way that it may go in a substep of h seconds, or soon after a blow in it, metres. */
static inline double phys_body_way(const phys_body *body, double h)
{
    const double BLOW = 2.0; /* m/s */
    return (2.0 * rlf_length(body->v) + BLOW) * h;
}

/* The solver moves it. */
static inline bool phys_body_is_moving(const phys_body *body)
{
    return body->is_alive && !body->is_asleep && body->inverse_mass > 0.0;
}

/* No contact moves it: it is held or kinematic. */
static inline bool phys_body_is_fixed(const phys_body *body)
{
    return body->inverse_mass == 0.0;
}

/* A kinematic body that moves now. */
static inline bool phys_body_is_driven(const phys_body *body)
{
    return body->is_kinematic && !body->is_held &&
           (rlf_dot(body->v, body->v) > 0.0 || rlf_dot(body->w, body->w) > 0.0);
}

/* It neither moves nor can be moved by what touches it. */
static inline bool phys_body_is_idle(const phys_body *body)
{
    return body->is_asleep || (phys_body_is_fixed(body) && !phys_body_is_driven(body));
}

static inline rlf_pose phys_body_pose(const phys_body *body)
{
    rlf_pose pose = {body->x, body->q};
    return pose;
}

/* Velocity of the body's point at r from its centre, eq. 4.11. */
static inline rlf_vec3 phys_body_velocity_at(const phys_body *body, rlf_vec3 r)
{
    return rlf_add(body->v, rlf_cross(body->w, r));
}

/* No point of it is faster, m/s. */
static inline double phys_body_speed(const phys_body *body)
{
    return rlf_length(body->v) + rlf_length(body->w) * body->shape.radius;
}

/* From the centre of the contact's body a to the touching point, world. */
static inline rlf_vec3 phys_contact_arm(const phys_contact *c, const phys_body *a)
{
    return rlf_mad(rlf_mat3_mul_vec(&a->R, c->anchor_a), c->normal, -c->rounding_a);
}

/* eq. 4.14 and 4.15 */
static inline void phys_body_push(phys_body *body, rlf_vec3 impulse, rlf_vec3 r)
{
    body->v = rlf_mad(body->v, impulse, body->inverse_mass);
    body->w =
        rlf_add(body->w, rlf_mat3_mul_vec(&body->inverse_inertia_world, rlf_cross(r, impulse)));
}

/* n.((I^-1 (r x n)) x r) + 1/m: how much the point at r speeds up per unit impulse along n. */
static inline double phys_body_mobility(const phys_body *body, rlf_vec3 r, rlf_vec3 n)
{
    rlf_vec3 turn = rlf_mat3_mul_vec(&body->inverse_inertia_world, rlf_cross(r, n));
    return body->inverse_mass + rlf_dot(n, rlf_cross(turn, r));
}

#endif
