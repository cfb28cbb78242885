/* A world for a few bodies, and its time. Clearing room for a thousand takes longer than the throw
 * of one ball, and many times longer with sanitizers. */
#ifndef RLF_TEST_SMALL_WORLD_H
#define RLF_TEST_SMALL_WORLD_H

#include "created.h"

static inline rlf_world_def small_world_def(void)
{
    rlf_world_def def = rlf_world_def_default();
    def.body_capacity = 32;
    def.contact_capacity = 2048;
    return def;
}

static inline rlf_world *small_world(rlf_vec3 gravity)
{
    rlf_world_def def = small_world_def();
    def.gravity = gravity;
    return world_of(&def);
}

/* So many steps in which nothing new is seen; the grid may be NULL. */
static inline void advance_steps(rlf_world *world, const rlf_grid *grid, int steps, double step)
{
    for (int k = 0; k < steps; k++) {
        rlf_world_advance(world, grid, step);
    }
}

/* So many steps, each with a new frame of the grid. */
static inline void advance_frames(rlf_world *world, rlf_grid *grid, int frames, double step)
{
    for (int k = 0; k < frames; k++) {
        grid->time_ns++;
        rlf_world_advance(world, grid, step);
    }
}

static inline const rlf_body_state *body_at(const rlf_world *world, int32_t index)
{
    return &rlf_world_get_snapshot(world)->bodies[index];
}

/* What one body by itself and without weight has become after so many frames of 1/30 s. */
static inline rlf_body_state alone_after(const rlf_body_def *def, rlf_grid *grid, int frames)
{
    rlf_world *alone = small_world(rlf_vec3_make(0, 0, 0));
    add_body(alone, def);
    advance_frames(alone, grid, frames, 1.0 / 30);
    const rlf_body_state state = *body_at(alone, 0);
    rlf_world_destroy(&alone);
    return state;
}

#endif
