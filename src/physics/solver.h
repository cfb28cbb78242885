/* Contact impulses between bodies, and between bodies and the surface. */
#ifndef RLF_PHYSICS_SOLVER_H
#define RLF_PHYSICS_SOLVER_H

#include "physics/world_state.h"

/* The speeds of a group's bodies while it is solved; a body that does not move has mobility 0. */
typedef struct phys_sides {
    rlf_vec3 v_a, w_a, v_b, w_b;
    double mobility_a, mobility_b; /* 1/kg */
} phys_sides;

static inline phys_group phys_group_of_pair(rlf_world *world, int32_t pair_index)
{
    phys_pair *pair = &world->pairs[pair_index];
    phys_group g = {pair->contacts, &world->bodies[pair->a], &world->bodies[pair->b],
                    &pair->stance,  pair->contact_count,     pair_index};
    return g;
}

static inline phys_group phys_group_of_body(rlf_world *world, int32_t body_index)
{
    phys_body *body = &world->bodies[body_index];
    int32_t key = world->pair_capacity + body_index;
    phys_group g = {body->surface, body, NULL, &body->stance, body->surface_count, key};
    return g;
}

static inline phys_sides phys_sides_load(const phys_group *g)
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

/* What does not move is not written: others may be reading it. */
static inline void phys_sides_store(const phys_sides *s, const phys_group *g)
{
    if (s->mobility_a > 0.0) {
        g->a->v = s->v_a;
        g->a->w = s->w_a;
    }
    if (g->b != NULL && s->mobility_b > 0.0) {
        g->b->v = s->v_b;
        g->b->w = s->w_b;
    }
}

/* Speed of a's point along the row's direction as b or the surface sees it. */
static inline double phys_row_speed(const phys_row *row, const phys_sides *s, bool has_b)
{
    double speed = rlf_dot(row->direction, s->v_a) + rlf_dot(row->turn_a, s->w_a);
    return has_b ? speed - rlf_dot(row->direction, s->v_b) - rlf_dot(row->turn_b, s->w_b)
                 : speed - row->drive;
}

static inline void phys_row_push(const phys_row *row, phys_sides *s, bool has_b, double impulse)
{
    s->v_a = rlf_mad(s->v_a, row->direction, impulse * s->mobility_a);
    s->w_a = rlf_mad(s->w_a, row->spin_a, impulse);
    if (has_b) {
        s->v_b = rlf_mad(s->v_b, row->direction, -impulse * s->mobility_b);
        s->w_b = rlf_mad(s->w_b, row->spin_b, -impulse);
    }
}

/* Sets the gaps of the group's contacts for a substep of h seconds, and their rows where a body has
 * turned. Returns whether any may touch in it. */
bool phys_group_prepare(const rlf_world *world, const phys_group *g, double h);

/* Starts from the impulses of the last substep. */
void phys_group_warm_start(const phys_group *g);

/* One pass over the group's contacts. With `bias` overlaps are pushed apart; without, the velocity
 * that the push gave is taken out again. Returns whether an impulse changed by more than rounding:
 * then the group asks for another pass. h: substep, s. */
bool phys_group_solve(const phys_group *g, bool bias, double h);

/* Solves friction of one contact within its cone, given the impulse of its normal's row. Returns
 * whether it changed. */
bool phys_contact_friction(phys_contact *c, phys_sides *s, bool has_b);

/* Adds this substep's impulses to the contacts' sums and marks bodies that a contact holds. */
void phys_group_finish(const phys_group *g);

/* Bounces of this substep: restitution at the time
 * of impact, in the order in which they happen. */
void phys_solve_impacts(rlf_world *world, const phys_island *island, const phys_group *groups,
                        int32_t count, double h);

/* Everything that happens to an island in a substep of h seconds. query NULL: empty space. */
struct grid_query;
void phys_island_substep(rlf_world *world, const phys_island *island,
                         const struct grid_query *query, double h);

/* Sorts the awake bodies and their pairs into world->islands. */
void phys_find_islands(rlf_world *world);

#endif
