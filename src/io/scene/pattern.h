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

#endif
