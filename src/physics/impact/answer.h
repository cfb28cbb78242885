/* What an impact does to the two sides of a group of contacts. */
#ifndef RLF_PHYSICS_IMPACT_ANSWER_H
#define RLF_PHYSICS_IMPACT_ANSWER_H

#include "physics/world_state.h"

/* The speeds of a group's bodies; a body that does not move has mobility 0. */
typedef struct phys_sides {
    rlf_vec3 v_a, w_a, v_b, w_b;
    double mobility_a, mobility_b; /* 1/kg */
} phys_sides;

static inline phys_sides sides_load(const phys_group *g)
{
    phys_sides s = {.v_a = g->a->v, .w_a = g->a->w};
    s.mobility_a = phys_body_is_moving(g->a) ? g->a->inverse_mass : 0.0;
    if (g->b != NULL) {
        s.v_b = g->b->v;
        s.w_b = g->b->w;
        s.mobility_b = phys_body_is_moving(g->b) ? g->b->inverse_mass : 0.0;
    }
    return s;
}

/* Velocity of a's point as b or the surface sees it. */
static inline rlf_vec3 relative_velocity(const phys_point *p, const phys_sides *s, bool has_b)
{
    rlf_vec3 of_a = rlf_add(s->v_a, rlf_cross(s->w_a, p->r_a));
    return rlf_sub(of_a, has_b ? rlf_add(s->v_b, rlf_cross(s->w_b, p->r_b)) : p->r_b);
}

/* Gap of the contact extrapolated back to the start of the substep. */
static inline double virtual_gap(const phys_point *p, const phys_group *g)
{
    rlf_vec3 shift = rlf_add(g->a->impact_shift, rlf_cross(g->a->impact_turn, p->r_a));
    if (g->b != NULL) {
        shift = rlf_sub(shift, g->b->impact_shift);
        shift = rlf_sub(shift, rlf_cross(g->b->impact_turn, p->r_b));
    }
    return p->separation + rlf_dot(p->normal, shift);
}

/* Of a, as b or the surface sees it. */
static inline rlf_vec3 acceleration_between(const phys_group *g)
{
    rlf_vec3 a = phys_body_is_moving(g->a) ? g->a->acceleration : rlf_vec3_make(0, 0, 0);
    if (g->b != NULL && phys_body_is_moving(g->b)) {
        a = rlf_sub(a, g->b->acceleration);
    }
    return a;
}

static inline double normal_acceleration(const phys_point *p, const phys_group *g)
{
    return rlf_dot(p->normal, acceleration_between(g));
}

/* All contacts that close at time t answer together: the normal velocities after are those before
 * times -restitution, found by sequential impulses within the group. */
void phys_impact_answer(const phys_group *g, double t);

#endif
