/* Random numbers in the order in which they are asked for: a hash of a key and a count. */
#ifndef RLF_SIM_RANDOM_DRAW_H
#define RLF_SIM_RANDOM_DRAW_H

#include "sim/hash.h"
#include "relief/math.h"

typedef struct synth_draw {
    uint32_t key, count;
} synth_draw;

static inline synth_draw synth_draw_start(uint64_t seed, uint32_t part)
{
    const uint32_t key = synth_hash2((uint32_t)seed, (uint32_t)(seed >> 32));
    return (synth_draw){synth_hash2(key, part), 0};
}

/* Uniform in [low, high). */
static inline double synth_draw_range(synth_draw *d, double low, double high)
{
    return low + (high - low) * (double)synth_uniform(synth_hash2(d->key, d->count++));
}

/* One of 0 .. count - 1. */
static inline int32_t synth_draw_index(synth_draw *d, int32_t count)
{
    const int32_t i = (int32_t)synth_draw_range(d, 0.0, count);
    return i < count ? i : count - 1;
}

static inline bool synth_draw_chance(synth_draw *d, double probability)
{
    return synth_draw_range(d, 0.0, 1.0) < probability;
}

#endif
