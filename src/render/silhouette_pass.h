/* What the parts of a silhouette's update share. */
#ifndef RLF_RENDER_SILHOUETTE_PASS_H
#define RLF_RENDER_SILHOUETTE_PASS_H

#include "silhouette.h"

typedef struct silhouette_pass {
    silhouette *s;
    const rlf_plane_f32 *z;
    const known_layer *known; /* NULL = no models */
    const uint8_t *exact;     /* its `shown` */
    const uint8_t *color;
    bool has_own_colors; /* the colours' pixels are the picture's, one beside the other */
    bool is_new;         /* a new frame: cover may move on */
} silhouette_pass;

static inline int32_t silhouette_at_most(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* silhouette_tiles.c: rows of tiles with jumps of depth, for rlf_parallel_for with a pass as
 * context; then marks of the tiles around these. */
void silhouette_find_jumps(void *context, int32_t begin, int32_t end, int32_t worker);
void silhouette_mark_tiles(silhouette *s);

/* silhouette_steady.c: what the lines settled becomes the cover, in rows of tiles likewise. */
void silhouette_steady_rows(void *context, int32_t begin, int32_t end, int32_t worker);
/* After a new picture's: how much noise changes the light. */
void silhouette_learn_noise(silhouette *s);

#endif
