/* What the parts of a matte's update share. */
#ifndef RLF_ENVIRONMENT_EDGE_MATTE_PASS_H
#define RLF_ENVIRONMENT_EDGE_MATTE_PASS_H

#include "environment/edge_matte.h"

typedef struct edge_matte_pass {
    edge_matte *s;
    const rlf_plane_f32 *z;
    const known_layer *known; /* NULL = no models */
    const uint8_t *exact;     /* its `shown` */
    const uint8_t *color;
    bool has_own_colors; /* the colours' pixels are the picture's, one beside the other */
    bool is_new;         /* a new frame: cover may move on */
} edge_matte_pass;

static inline int32_t edge_matte_at_most(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* edge_matte_tiles.c: rows of tiles with jumps of depth, for rlf_parallel_for with a pass as
 * context; then marks of the tiles around these. */
void edge_matte_find_jumps(void *context, int32_t begin, int32_t end, int32_t worker);
void edge_matte_mark_tiles(edge_matte *s);

/* edge_matte_steady.c: what the lines settled becomes the cover, in rows of tiles likewise. */
void edge_matte_steady_rows(void *context, int32_t begin, int32_t end, int32_t worker);
/* After a new picture's: how much noise changes the light. */
void edge_matte_learn_noise(edge_matte *s);

#endif
