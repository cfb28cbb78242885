/* The contact solver of the live method: sequential impulses with small steps. */
#ifndef RLF_PHYSICS_SOLVER_H
#define RLF_PHYSICS_SOLVER_H

#include "physics/world_state.h"

/* Gathers all contacts of bodies that move into world->active and prepares them for a substep. */
void phys_solver_prepare(rlf_world *world);

/* Starts from the impulses of the last substep. */
void phys_solver_warm_start(rlf_world *world);

/* One pass over all contacts. With `bias` overlaps are pushed apart; without, the velocity that the
 * push gave is taken out again. h: substep, s. */
void phys_solver_pass(rlf_world *world, bool bias, double h);

/* Marks bodies that a contact holds. */
void phys_solver_mark_pressed(rlf_world *world);

/* Writes this substep's impulses to the frame's contact list. */
void phys_solver_log(rlf_world *world);

/* Relative velocity of the contact's points, a minus b or surface. */
rlf_vec3 phys_contact_velocity(const rlf_world *world, const phys_contact *contact);

/* Pushes both bodies of a contact. */
void phys_contact_push(rlf_world *world, const phys_contact *contact, rlf_vec3 impulse);

/* Solves friction of one contact within its cone, given the normal impulse in impulse_n. */
void phys_contact_friction(rlf_world *world, phys_contact *contact);

/* Bounces of this substep: restitution at the time of impact, in the order in which they happen. */
void phys_solve_impacts(rlf_world *world, double h);

#endif
