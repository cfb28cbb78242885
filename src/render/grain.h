/* The camera's noise, measured where the picture is flat and given to bodies. Shared by both
 * renderers.
 *
 * From one picture to the next, neighbouring pixels of a flat place change alike, whether the
 * camera moves or the light does, but for noise: per brightness its variance, how alike it is in
 * neighbouring pixels, and in the three channels.
 * Bodies get noise of that kind from a tile that is moved from picture to picture. */
#ifndef RLF_RENDER_GRAIN_H
#define RLF_RENDER_GRAIN_H

#include "base/inside.h"
#include "relief/frame.h"

enum {
    GRAIN_BINS = 16,    /* of brightness, 16 codes each */
    GRAIN_TILE = 128,   /* pixels on a side; a power of two */
    GRAIN_SPOTS = 4096, /* places that are looked at */
    GRAIN_PIXELS = 4    /* of a place */
};

/* A pixel and three near it. */
typedef struct grain_spot {
    uint8_t rgb[GRAIN_PIXELS][3];
} grain_spot;

typedef struct grain {
    float sigma[GRAIN_BINS][3]; /* codes 0..255, as measured; */
    float at[256][3];           /* of each brightness: linear between the middles of those */
    float beside[2];            /* correlation with the next pixel in the row, in the column */
    float common;               /* and of the channels */
    bool is_seen[GRAIN_BINS], is_known;
    uint64_t sequence; /* of the last frame taken in */
    int32_t width, height;
    int32_t offset_x, offset_y; /* of the tile, in this picture */
    int32_t blur[2], mixed;     /* the tile's: those correlations in 32nds, -1 = not made */
    grain_spot last[GRAIN_SPOTS];
    float tile[GRAIN_TILE * GRAIN_TILE][3]; /* mean 0, variance 1 */
    float white[GRAIN_TILE * GRAIN_TILE][4];
} grain;

void grain_init(grain *g) RLF_INSIDE(grain_init);
/* Takes a frame in, when it is another one. Without colour, or after a cut, nothing is known. */
void grain_update(grain *g, const rlf_frame *frame) RLF_INSIDE(grain_update);

/* The tile's row for row y of the picture. */
static inline const float (*grain_row(const grain *g, int32_t y))[3]
{
    return &g->tile[(y + g->offset_y) % GRAIN_TILE * GRAIN_TILE];
}

#endif
