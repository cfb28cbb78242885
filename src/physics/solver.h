/* Contact impulses between bodies, and between bodies and the surface. */
#ifndef RLF_PHYSICS_SOLVER_H
#define RLF_PHYSICS_SOLVER_H

#include "physics/body.h"
#include "physics/grid/contact/contact.h"
#include "physics/world_state.h"

/* Lists those contacts that may touch in a substep of h seconds, and sets the gaps of all.
 * Returns whether there are any. `points` has room for all of them. */
bool phys_group_of_pair(rlf_world *world, int32_t pair_index, double h, phys_point *points,
                        phys_group *out);
bool phys_group_of_body(rlf_world *world, int32_t body_index, double h, phys_point *points,
                        phys_group *out);

/* Sets world->lightness of the bodies below in the groups, of which those of pairs come first; it
 * is 1 before. */
void phys_bear_burdens(rlf_world *world, const phys_group *groups, int32_t count);

/* Sorts the island's groups into batches whose lanes share no body that moves: the pairs' first.
 * Returns their number; they begin at phys_batches_of. */
int32_t phys_batches_make(rlf_world *world, const phys_island *island, const phys_group *groups,
                          int32_t count, double h);

static inline phys_batch *phys_batches_of(const rlf_world *world, const phys_island *island)
{
    return world->batches + island->pair_begin + island->body_begin;
}

/* Adds this substep's impulses to the contacts' sums and keeps them for the next one. */
void phys_batches_finish(const phys_batch *batches, int32_t count);

/* Starts from the impulses of the last substep. */
void phys_batches_warm_start(rlf_world *world, const phys_batch *batches, int32_t count);

/* Passes over the batches next to which something still changes. With `push` overlaps are pushed
 * apart; without, the velocity that the push gave is taken out again. */
void phys_batches_solve(rlf_world *world, const phys_batch *batches, int32_t count, bool push,
                        int32_t passes);

/* Bounces of this substep: restitution at the time of impact, in the order in which they happen.
 * Of the groups, those of pairs come first. */
void phys_solve_impacts(rlf_world *world, const phys_island *island, const phys_group *groups,
                        int32_t count, double h);

/* Everything that happens to an island in a substep of h seconds. query NULL: empty space. */
struct grid_query;
void phys_island_substep(rlf_world *world, const phys_island *island,
                         const struct grid_query *query, double h);

/* Sorts the awake bodies and their pairs into world->islands. */
void phys_find_islands(rlf_world *world);

/* ---- integrate.c: motion of one body over one substep: exact free fall and a geometric
 * rotation. */

/* Turns the body by its angular velocity over h seconds; without a torque the angular momentum in
 * the world is conserved and the energy to fourth order. */
void phys_integrate_rotation(phys_body *body, double h);

/* Moves the centre and turns the body over h seconds. The velocity already holds a h. A free body
 * moves by v h + a h^2 / 2 with its old v, exact under constant acceleration; one that a contact
 * held moves with its new velocity, which the solver made fit the contact. */
void phys_integrate_position(phys_body *body, double h);

/* ---- sleep.c: rest: bodies that hardly move stop being simulated until something touches them. */

/* Ends the sleep of bodies whose surface moved, came closer or went away, or
 * will come to them within `horizon` seconds. */
void phys_wake_by_surface(rlf_world *world, const grid_query *query, double horizon);

/* Ends the sleep of bodies that a moving one touches, or will within `horizon` seconds. */
void phys_wake_by_touch(rlf_world *world, double horizon);

/* Puts bodies to sleep that have been still for half a second and touch nothing restless. */
void phys_fall_asleep(rlf_world *world, double h);

#endif
