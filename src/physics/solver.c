/* Sequential impulses with substeps and a relaxation pass (Macklin et al. 2019, "Small steps";
 * Catto 2024, "Solver2D"): one search for contacts, many small steps, impulses kept. */
#include "physics/solver.h"

/* Contacts are springs of half the substep rate, critically damped, solved implicitly (Catto 2011,
 * "Soft constraints"): omega h = pi, a1 = 2 zeta + omega h, a2 = omega h a1. A tall stack stands
 * still where rigid contacts, solved by a few passes, keep tilting it. */
#define SOFT_OMEGA_H RLF_PI
#define SOFT_A1 (2.0 + SOFT_OMEGA_H)
#define SOFT_A2 (SOFT_OMEGA_H * SOFT_A1)
/* Overlaps are pushed apart no faster than this, m/s. */
#define PUSH_SPEED_MAX 3.0
/* Overlap left alone, as a share of the body's radius, so that contacts persist. */
#define SLOP_SHARE 0.002

rlf_vec3 phys_contact_velocity(const rlf_world *world, const phys_contact *contact)
{
    rlf_vec3 v = phys_body_velocity_at(&world->bodies[contact->a], contact->r_a);
    rlf_vec3 other = contact->b >= 0
                         ? phys_body_velocity_at(&world->bodies[contact->b], contact->r_b)
                         : contact->surface_velocity;
    return rlf_sub(v, other);
}

void phys_contact_push(rlf_world *world, const phys_contact *contact, rlf_vec3 impulse)
{
    phys_body_push(&world->bodies[contact->a], impulse, contact->r_a);
    if (contact->b >= 0) {
        phys_body_push(&world->bodies[contact->b], rlf_neg(impulse), contact->r_b);
    }
}

static double effective_mass(const rlf_world *world, const phys_contact *contact, rlf_vec3 n)
{
    double mobility = phys_body_mobility(&world->bodies[contact->a], contact->r_a, n);
    if (contact->b >= 0) {
        mobility += phys_body_mobility(&world->bodies[contact->b], contact->r_b, n);
    }
    return mobility > 0.0 ? 1.0 / mobility : 0.0;
}

static void prepare_contact(rlf_world *world, phys_contact *contact)
{
    const phys_body *a = &world->bodies[contact->a];
    rlf_vec3 n = contact->normal;
    contact->r_a = rlf_mad(rlf_mat3_mul_vec(&a->R, contact->anchor_a), n, -contact->rounding_a);
    rlf_vec3 on_a = rlf_add(a->x, contact->r_a);
    rlf_vec3 on_b;
    if (contact->b >= 0) {
        const phys_body *b = &world->bodies[contact->b];
        contact->r_b = rlf_mad(rlf_mat3_mul_vec(&b->R, contact->anchor_b), n, contact->rounding_b);
        on_b = rlf_add(b->x, contact->r_b);
    } else {
        on_b = rlf_mad(contact->anchor_b, contact->surface_velocity,
                       world->time - contact->surface_time);
    }
    contact->separation = rlf_dot(n, rlf_sub(on_a, on_b));
    contact->tangent[0] = rlf_perpendicular(n);
    contact->tangent[1] = rlf_cross(n, contact->tangent[0]);
    contact->mass_n = effective_mass(world, contact, n);
    contact->mass_t[0] = effective_mass(world, contact, contact->tangent[0]);
    contact->mass_t[1] = effective_mass(world, contact, contact->tangent[1]);
    contact->is_impacted = false;
}

static bool is_moving(const phys_body *body)
{
    return body->is_alive && !body->is_asleep && body->inverse_mass > 0.0;
}

void phys_solver_prepare(rlf_world *world)
{
    world->active_count = 0;
    for (int32_t i = 0; i < world->pair_count; i++) {
        phys_pair *pair = &world->pairs[i];
        if (!is_moving(&world->bodies[pair->a]) && !is_moving(&world->bodies[pair->b])) {
            continue;
        }
        for (int32_t k = 0; k < pair->contact_count; k++) {
            world->active[world->active_count++] = &pair->contacts[k];
        }
    }
    /* The real surface comes last in a pass: nothing gives way less. */
    for (int32_t i = 0; i < world->body_top; i++) {
        phys_body *body = &world->bodies[i];
        for (int32_t k = 0; is_moving(body) && k < body->surface_count; k++) {
            world->active[world->active_count++] = &body->surface[k];
        }
    }
    for (int32_t i = 0; i < world->active_count; i++) {
        prepare_contact(world, world->active[i]);
    }
}

static rlf_vec3 friction_vector(const phys_contact *c)
{
    return rlf_add(rlf_scale(c->tangent[0], c->impulse_t[0]),
                   rlf_scale(c->tangent[1], c->impulse_t[1]));
}

void phys_solver_warm_start(rlf_world *world)
{
    for (int32_t i = 0; i < world->active_count; i++) {
        const phys_contact *c = world->active[i];
        if (c->impulse_n > 0.0) {
            phys_contact_push(world, c, rlf_mad(friction_vector(c), c->normal, c->impulse_n));
        }
    }
}

static void solve_normal(rlf_world *world, phys_contact *c, bool bias, double h)
{
    double slop = SLOP_SHARE * world->bodies[c->a].shape.radius;
    double target = 0.0; /* least normal velocity */
    double mass_scale = 1.0, impulse_scale = 0.0;
    if (c->separation > 0.0) {
        target = -c->separation / h; /* may close the gap, not more */
    } else if (bias && !c->is_impacted) {
        mass_scale = SOFT_A2 / (1.0 + SOFT_A2);
        impulse_scale = 1.0 / (1.0 + SOFT_A2);
        double overlap = rlf_min(c->separation + slop, 0.0);
        target = rlf_min(-SOFT_OMEGA_H / SOFT_A1 / h * overlap, PUSH_SPEED_MAX);
    }
    double v = rlf_dot(c->normal, phys_contact_velocity(world, c));
    double change = c->mass_n * mass_scale * (target - v) - impulse_scale * c->impulse_n;
    double sum = rlf_max(0.0, c->impulse_n + change);
    change = sum - c->impulse_n;
    c->impulse_n = sum;
    if (change != 0.0) {
        phys_contact_push(world, c, rlf_scale(c->normal, change));
    }
}

void phys_contact_friction(rlf_world *world, phys_contact *c)
{
    double limit = c->friction * c->impulse_n;
    rlf_vec3 before = friction_vector(c);
    if (limit == 0.0 && c->impulse_t[0] == 0.0 && c->impulse_t[1] == 0.0) {
        return;
    }
    rlf_vec3 v = phys_contact_velocity(world, c);
    for (int32_t k = 0; k < 2; k++) {
        c->impulse_t[k] -= c->mass_t[k] * rlf_dot(c->tangent[k], v);
    }
    double length = sqrt(c->impulse_t[0] * c->impulse_t[0] + c->impulse_t[1] * c->impulse_t[1]);
    if (length > limit) { /* Coulomb's cone */
        c->impulse_t[0] *= limit / length;
        c->impulse_t[1] *= limit / length;
    }
    phys_contact_push(world, c, rlf_sub(friction_vector(c), before));
}

void phys_solver_pass(rlf_world *world, bool bias, double h)
{
    int32_t last = world->active_count - 1;
    for (int32_t i = 0; i <= last; i++) {
        solve_normal(world, world->active[i], bias, h);
    }
    for (int32_t i = 0; i <= last; i++) {
        phys_contact_friction(world, world->active[i]);
    }
    for (int32_t i = last; i >= 0; i--) { /* and back: no corner of a face is always the first */
        solve_normal(world, world->active[i], bias, h);
    }
}

void phys_solver_mark_pressed(rlf_world *world)
{
    for (int32_t i = 0; i < world->active_count; i++) {
        const phys_contact *c = world->active[i];
        if (c->impulse_n > 0.0) {
            world->bodies[c->a].is_pressed = true;
            if (c->b >= 0) {
                world->bodies[c->b].is_pressed = true;
            }
        }
    }
}

void phys_solver_log(rlf_world *world)
{
    for (int32_t i = 0; i < world->active_count; i++) {
        phys_contact *c = world->active[i];
        if (c->impulse_n > 0.0) {
            phys_log_impulse(world, c, c->impulse_n, 0.0);
        }
    }
}
