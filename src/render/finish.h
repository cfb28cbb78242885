/* What a camera does to a picture, done to bodies: its blur, measured at the room's edges, and its
 * noise (grain.h). The last step of both renderers. */
#ifndef RLF_RENDER_FINISH_H
#define RLF_RENDER_FINISH_H

#include "base/inside.h"
#include "render/grain.h"

enum {
    FINISH_BINS = 32, /* of widths */
    FINISH_TILE = 32  /* pixels */
};

#define FINISH_BIN_PX 0.125f /* of a width */

typedef struct finish {
    grain noise;
    float widths[FINISH_BINS]; /* edges of the room, by their width: past ones count less */
    float width_px;            /* of the sharp ones, from 10 to 90 %; 0 = not known */
    uint64_t sequence;         /* of the last frame whose edges were looked at */
    uint8_t *sharp;            /* the picture before it was blurred, where it is */
    uint64_t *marks;           /* a bit for each tile of a row, 64 in a word: bodies are there */
    int32_t width, height, columns, words;
} finish;

rlf_result finish_create(int32_t width, int32_t height, finish *out) RLF_INSIDE(finish_create);
void finish_destroy(finish *f) RLF_INSIDE(finish_destroy);
/* Takes a frame in. */
void finish_look(finish *f, const rlf_frame *frame) RLF_INSIDE(finish_look);
/* Blurs and grains what the matte shows, in place. Both are of the size that was created. */
void finish_picture(finish *f, rlf_pool *pool, const rlf_image_rgba8 *image,
                    const rlf_plane_u8 *matte) RLF_INSIDE(finish_picture);

#endif
