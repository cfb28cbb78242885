/* Where the bodies of a spawn pattern are. */
#ifndef RLF_IO_SCENE_PATTERN_H
#define RLF_IO_SCENE_PATTERN_H

#include "relief/math.h"

typedef enum io_pattern_kind {
    IO_PATTERN_GRID,
    IO_PATTERN_STACK,
    IO_PATTERN_RING,
    IO_PATTERN_RANDOM
} io_pattern_kind;

typedef struct io_pattern {
    io_pattern_kind kind;
    int32_t count;    /* bodies in all, >= 1 */
    int32_t along[3]; /* grid: bodies along x, y and z */
    rlf_vec3 spacing; /* grid: metres between centres, > 0; stack: y only */
    double radius;    /* ring, metres */
    rlf_vec3 box;     /* random: full extents, metres; not all 0 unless count is 1 */
    double reach;     /* random: largest distance from a body's centre to its surface, metres */
    rlf_vec3 up;      /* stack and ring, of unit length */
    int32_t seed;     /* random */
} io_pattern;

/* Places of the `count` centres, metres from the pattern's position. Only memory can fail. */
rlf_result io_pattern_place(const io_pattern *pattern, rlf_vec3 *out);

/* ---- Random numbers from a seed, the same on every machine: SplitMix64 (Steele, Lea, Flood 2014)
 */

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
