/* Random numbers from a seed, the same on every machine: SplitMix64 (Steele, Lea, Flood 2014). */
#ifndef RLF_IO_SCENE_RANDOM_H
#define RLF_IO_SCENE_RANDOM_H

#include "relief/math.h"

typedef struct io_random {
    uint64_t state;
} io_random;

static inline uint64_t io_random_next(io_random *r)
{
    r->state += 0x9e3779b97f4a7c15u;
    uint64_t z = r->state;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* One of a seed's streams; they have nothing to do with each other. */
static inline io_random io_random_make(int32_t seed, int32_t stream)
{
    io_random r = {(uint64_t)(uint32_t)seed << 32 | (uint32_t)stream};
    r.state = io_random_next(&r);
    return r;
}

/* Uniform in [0, 1). */
static inline double io_random_uniform(io_random *r)
{
    return (double)(io_random_next(r) >> 11) * 0x1p-53;
}

/* Uniform in [-reach, reach), each by itself. */
static inline rlf_vec3 io_random_about(io_random *r, rlf_vec3 reach)
{
    double x = 2.0 * io_random_uniform(r) - 1.0;
    double y = 2.0 * io_random_uniform(r) - 1.0;
    double z = 2.0 * io_random_uniform(r) - 1.0;
    return rlf_vec3_make(x * reach.x, y * reach.y, z * reach.z);
}

/* All orientations alike (Shoemake 1992). */
static inline rlf_quat io_random_turn(io_random *r)
{
    double u = io_random_uniform(r);
    double a = 2.0 * RLF_PI * io_random_uniform(r), b = 2.0 * RLF_PI * io_random_uniform(r);
    double s = sqrt(1.0 - u), c = sqrt(u);
    const rlf_quat q = {s * rlf_sin(a), s * rlf_cos(a), c * rlf_sin(b), c * rlf_cos(b)};
    return rlf_quat_normalize(q);
}

#endif
