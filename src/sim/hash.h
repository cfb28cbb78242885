/* Counter-based random numbers: a hash of (seed, frame, row, column), so that a pixel's number does
 * not depend on the order in which pixels are visited. */
#ifndef RLF_SIM_HASH_H
#define RLF_SIM_HASH_H

#include "relief/math.h"

#include <stdint.h>

/* Finaliser of MurmurHash3 (Appleby 2011): every input bit changes every output bit with p ~ 1/2.
 */
static inline uint32_t synth_hash(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x85ebca6bu;
    x ^= x >> 13;
    x *= 0xc2b2ae35u;
    x ^= x >> 16;
    return x;
}

/* What of synth_hash2 many `a` share. */
static inline uint32_t synth_hash_row(uint32_t b)
{
    return synth_hash(b) + 0x9e3779b9u;
}

static inline uint32_t synth_hash2(uint32_t a, uint32_t b)
{
    return synth_hash(a ^ synth_hash_row(b));
}

/* Standard deviation of the sum of four uniform bytes: sqrt(4 (256^2 - 1) / 12). */
#define SYNTH_NORMAL_SCALE (1.0f / 147.8006f)

/* Approximately standard normal (Irwin-Hall of the four bytes), bounded by +-3.45. */
static inline float synth_normal(uint32_t h)
{
    int32_t sum = (int32_t)((h & 255u) + ((h >> 8) & 255u) + ((h >> 16) & 255u) + (h >> 24)) - 510;
    return (float)sum * SYNTH_NORMAL_SCALE;
}

/* Uniform in [0, 1). */
static inline float synth_uniform(uint32_t h)
{
    return (float)(h >> 8) * (1.0f / 16777216.0f);
}

/* ---- Random numbers in the order in which they are asked for: a hash of a key and a count. */

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
