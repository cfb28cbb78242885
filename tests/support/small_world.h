/* A world for a few bodies. Clearing room for a thousand takes longer than the throw of one ball,
 * and many times longer with sanitizers. */
#ifndef RLF_TEST_SMALL_WORLD_H
#define RLF_TEST_SMALL_WORLD_H

#include "relief/world.h"

static inline rlf_world_def small_world_def(void)
{
    rlf_world_def def = rlf_world_def_default();
    def.body_capacity = 32;
    def.contact_capacity = 2048;
    return def;
}

#endif
