/* The world object, as the files of this module see it. */
#ifndef RLF_PHYSICS_WORLD_STATE_H
#define RLF_PHYSICS_WORLD_STATE_H

#include "physics/body.h"
#include "physics/grid_shell.h"
#include "physics/grid_tiles.h"

/* Two bodies that are near each other. */
typedef struct phys_pair {
    int32_t a, b; /* a < b */
    int32_t contact_count;
    phys_contact contacts[PHYS_PAIR_CONTACTS];
} phys_pair;

/* Interval of a body along the sweep axis. */
typedef struct phys_interval {
    double low, high;
    int32_t body;
} phys_interval;

/* Two things that touched during an advance. */
typedef struct phys_touch {
    uint64_t key; /* body index, then the other: 1, 2 = the sheets, 3 + index of a body */
    rlf_body_id body, other_body;
} phys_touch;

struct rlf_world {
    rlf_world_def def;
    phys_body *bodies;
    int32_t body_top; /* bodies beyond it were never used */

    phys_pair *pairs, *old_pairs; /* sorted by (a, b) */
    int32_t pair_count, old_pair_count, pair_capacity;
    phys_interval *intervals;
    int32_t *island; /* union-find parents, one per body */
    phys_contact **active;
    double *event_times;   /* see impact.c */
    int32_t *event_counts; /* of this substep, per group */
    int32_t *pending;      /* groups that have an event */
    int32_t *pair_head;    /* first link of each body's list of pairs, -1 = none */
    int32_t *pair_next;    /* link 2 k is pair k as seen from its a, 2 k + 1 from its b */
    int32_t active_capacity, active_count;

    phys_touch *touches, *old_touches; /* of this advance and the one before, sorted by key */
    int32_t touch_count, old_touch_count;
    rlf_contact_event *events; /* of this advance */
    int32_t event_count;

    rlf_contact *log; /* contacts of this frame; capacity def.contact_capacity */
    int32_t log_count;
    rlf_body_state *states;
    rlf_snapshot snapshot;

    rlf_world_times times; /* of this advance */

    double time; /* s */
    uint64_t frame;
    int32_t substep; /* of this advance */

    bool has_grid; /* whether the last advance saw one, and where its time stands */
    int64_t grid_time_ns;
    double grid_tau; /* s from when the grid was seen to now, negative before */
    grid_tiles foreground_tiles, background_tiles;
    grid_shell shell;
    rlf_pose shell_pose; /* of the grid in the world when the shell was found */
    double shell_time;   /* ... and the world's time */
};

/* Writes the snapshot from the bodies and the contact log. */
void phys_world_publish(rlf_world *world);

/* Lets go of bodies whose release time has come, and sets the masses of the held ones to none. */
void phys_world_release(rlf_world *world);

/* Removes bodies whose centre left the scene (Algorithm 1: "while x(t) is within the scene"). */
void phys_world_remove_strays(rlf_world *world);

/* Ends a body's sleep. */
void phys_body_wake(phys_body *body);

/* Adds `impulse` at `contact` to the frame's contact list. */
void phys_log_impulse(rlf_world *world, phys_contact *contact, double impulse, double approach);

/* Lists the touches that began and ended in this advance. */
void phys_find_events(rlf_world *world);

/* One advance by each method. */
void phys_live_advance(rlf_world *world, const rlf_grid *grid, double dt);
void phys_thesis_advance(rlf_world *world, const rlf_grid *grid, double dt);

/* Whether the grid's room goes on where the camera does not look. */
static inline bool phys_world_has_shell(const rlf_world *world, const rlf_grid *grid)
{
    return world->def.border == RLF_BORDER_EXTEND || grid->background.border == RLF_BORDER_EXTEND;
}

/* Adds the milliseconds since *clock_ns to *sum_ms and sets the clock. */
static inline void phys_clock(int64_t *clock_ns, double *sum_ms)
{
    int64_t now = rlf_clock_ns();
    *sum_ms += 1e-6 * (double)(now - *clock_ns);
    *clock_ns = now;
}

static inline rlf_body_id phys_body_id(const rlf_world *world, int32_t index)
{
    rlf_body_id id = {(uint32_t)index + 1u, world->bodies[index].generation};
    return id;
}

#endif
