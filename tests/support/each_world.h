/* A world for each test, empty, with gravity along y; gone after it. TEST_EACH(start_world,
 * stop_world). A test that lets several bodies do the same one after another resets it. */
#ifndef RLF_TEST_EACH_WORLD_H
#define RLF_TEST_EACH_WORLD_H

#include "small_world.h"

static rlf_world *world;

static inline int start_world(void **state)
{
    (void)state;
    rlf_world_def def = small_world_def();
    def.body_capacity = 128;
    world = world_of(&def);
    return 0;
}

static inline int stop_world(void **state)
{
    (void)state;
    rlf_world_destroy(&world);
    return 0;
}

static inline void no_gravity(void)
{
    assert_true(rlf_world_set_gravity(world, rlf_vec3_make(0, 0, 0)));
}

#endif
