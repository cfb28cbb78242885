/* Rest: bodies that hardly move stop being simulated until something touches them. */
#ifndef RLF_PHYSICS_SLEEP_H
#define RLF_PHYSICS_SLEEP_H

#include "physics/grid/contact/contact.h"
#include "physics/world_state.h"

/* Ends the sleep of bodies whose surface moved, came closer or went away, or
 * will come to them within `horizon` seconds. */
void phys_wake_by_surface(rlf_world *world, const grid_query *query, double horizon);

/* Ends the sleep of bodies that a moving one touches, or will within `horizon` seconds. */
void phys_wake_by_touch(rlf_world *world, double horizon);

/* Puts bodies to sleep that have been still for half a second and touch nothing restless. */
void phys_fall_asleep(rlf_world *world, double h);

#endif
