/* How much a heavy test does. Sanitizers make a test 10 to 20 times as slow, and find what they
 * look for in the first rounds of a loop. The release build does every round, and judges the
 * figures. */
#ifndef RLF_TEST_HEAVY_H
#define RLF_TEST_HEAVY_H

#include "test.h"

#include <stdbool.h>

#ifndef RLF_TEST_SANITIZED
#define RLF_TEST_SANITIZED 0
#endif

/* Bodies, frames, seeds or rounds: `all` of them as released, `few` with sanitizers. */
static inline int heavy(int all, int few)
{
    return RLF_TEST_SANITIZED ? few : all;
}

/* Whether figures that take all the rounds are there to be judged. */
static inline bool heavy_is_whole(void)
{
    return !RLF_TEST_SANITIZED;
}

/* Ends a test whose code others run with sanitizers: for its figures alone. */
static inline void heavy_needs_whole(void)
{
    if (!heavy_is_whole()) {
        skip();
    }
}

#endif
