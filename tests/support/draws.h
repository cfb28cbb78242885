/* Numbers that look drawn and are the same in every run. */
#ifndef RLF_TEST_DRAWS_H
#define RLF_TEST_DRAWS_H

#include "relief/math.h"

#include <stdint.h>

/* Knuth's 64-bit linear congruential generator. */
static inline double draw(uint64_t *seed, double low, double high)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ((double)(*seed >> 11) / 9007199254740992.0);
}

/* Of a box. In order: a compiler may evaluate a call's arguments in any. */
static inline rlf_vec3 draw_in_box(uint64_t *seed, rlf_vec3 low, rlf_vec3 high)
{
    rlf_vec3 v;
    v.x = draw(seed, low.x, high.x);
    v.y = draw(seed, low.y, high.y);
    v.z = draw(seed, low.z, high.z);
    return v;
}

/* Within `size` of 0 on each axis. */
static inline rlf_vec3 draw_vector(uint64_t *seed, double size)
{
    return draw_in_box(seed, rlf_vec3_make(-size, -size, -size), rlf_vec3_make(size, size, size));
}

/* Twelve uniform numbers: a fair normal one. */
static inline double draw_normal(uint64_t *seed)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        sum += draw(seed, 0, 1);
    }
    return sum;
}

#endif
