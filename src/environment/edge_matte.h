/* The matte of real things along depth edges where bodies are, to less than a pixel.
 *
 * Depth knows who is in front of whom, but its edges are as coarse as its pixels and ragged; the
 * colour image has the edge itself. Around every depth edge that matters to a body a line of pixels
 * across it is split where the colours change from those of the near side to those of the far
 * side; what the split pixels are mixed of gives the share of the near side. Where both sides look
 * alike the depth's own edge stays. */
#ifndef RLF_ENVIRONMENT_EDGE_MATTE_H
#define RLF_ENVIRONMENT_EDGE_MATTE_H

#include "base/inside.h"
#include "camera/pixel_rect.h"
#include "environment/depth_edge.h"
#include "known/layer.h"
#include "relief/frame.h"

#define EDGE_MATTE_FAR 1e9f      /* depth of what hides nothing */
#define EDGE_MATTE_TILE 16       /* pixels */
#define EDGE_MATTE_STILL_LIGHT 2 /* steps of a light that noise may change, at least */
#define EDGE_MATTE_NONE 255      /* distance: no edge near */
#define EDGE_MATTE_PICTURES 1023 /* are told apart by their numbers */

/* Depths of the bodies in and around a tile; far_z < near_z when there are none. */
typedef struct edge_matte_tile {
    float near_z, far_z;
} edge_matte_tile;

/* What a tile is. Where no edge reaches a pixel shows all of the registered depth. */
enum {
    EDGE_MATTE_JUMPS =
        1,               /* depth jumps, where bodies are, between its pixels or to the next ones */
    EDGE_MATTE_EDGE = 2, /* it, or a tile beside it, jumps: look at near_z, far_z and cover */
    EDGE_MATTE_FILLED = 4,  /* near_z, far_z and cover are set: in and around those with an edge */
    EDGE_MATTE_WAS_EDGE = 8 /* of the last picture: while it has bodies it stays one */
};
#define EDGE_MATTE_AROUND 1 /* tiles to the left and right of an edge's that are filled too */

/* How much the light of pixels changed from one picture to the next, and in how many values. */
typedef struct edge_matte_change {
    int32_t sum, count;
} edge_matte_change;

typedef struct edge_matte {
    /* The real world in the filled tiles: a pixel shows `cover` of near_z, the rest of far_z.
     * EDGE_MATTE_FAR where there is no depth. */
    rlf_plane_f32 near_z, far_z;
    rlf_plane_u8 cover; /* 255 = all */

    /* Per pixel, what is looked at together. settled: pixels to the edge that set the pixel, or
     * EDGE_MATTE_NONE, times 256 + cover as the lines have it, one by one. last: number of the
     * picture that set it times 2^22 + light (14 bits) times 256 + cover. */
    uint16_t *settled;
    uint32_t *last;
    /* near_z and far_z of that picture, and for how many pictures that surface is kept though
     * another one seems to be seen. */
    float *held_near, *held_far;
    uint8_t *trust;
    edge_matte_change *changes; /* of each row of tiles */
    int32_t still_light;        /* steps of a light that are noise, by those */
    uint16_t picture;           /* counts up, never 0 */
    uint64_t last_sequence;     /* of the frame */

    edge_matte_tile *tiles;
    edge_matte_tile *own;  /* the same without the neighbours */
    edge_matte_tile *real; /* depths of the real world in those, with the pixels next to them, at
                              least: from 0 to EDGE_MATTE_FAR where some of it is missing */
    uint8_t *marks;        /* of the tiles with bodies in or around them; 0 for others */
    bool fills_all;        /* every tile with bodies is filled; default false */
    int32_t columns, rows;
    ptrdiff_t *offset_x, *offset_y; /* bytes of a picture's pixel in the colour image */
    int32_t reach;                  /* pixels on each side of a depth edge that may be wrong */
    rlf_pool *pool;
} edge_matte;

/* `camera` is the picture's, `depth` the one that was registered. */
rlf_result edge_matte_create(const rlf_camera *camera, const rlf_camera *depth, rlf_pool *pool,
                             edge_matte *out) RLF_INSIDE(edge_matte_create);
void edge_matte_destroy(edge_matte *s) RLF_INSIDE(edge_matte_destroy);

/* Takes the place of the last picture's bodies: none, then each of them as a ball in the picture
 * camera's frame; at the end, what is around them. `camera` is the picture's. */
void edge_matte_clear_bodies(edge_matte *s);
void edge_matte_add_body(edge_matte *s, const rlf_camera *camera, rlf_vec3 center, double radius);
/* Where their shadows fall: pixels, and depths near_z..far_z. */
void edge_matte_add_shadow(edge_matte *s, const pixel_rect *rect, double near_z, double far_z);
void edge_matte_spread_bodies(edge_matte *s);
/* Fills near_z, far_z and cover where a body may meet an edge. z is the registered depth; the
 * frame's colour may be missing. `known`, of the picture's camera, has covered z: its models' edges
 * are exact. NULL = none. */
void edge_matte_update(edge_matte *s, const rlf_plane_f32 *z, const known_layer *known,
                       const rlf_frame *frame) RLF_INSIDE(edge_matte_update);

/* What pixels showed is no longer there: the next update is as the first. */
void edge_matte_forget(edge_matte *s) RLF_INSIDE(edge_matte_forget);

/* edge_matte_line.c: a row or a column of the picture; all steps are to the next pixel of it. */
typedef struct edge_matte_line {
    const float *z;
    const uint8_t *exact;          /* 1 = the depth is a model's; NULL = none */
    const uint8_t *color;          /* of the line; NULL = none */
    const uint8_t *beside[2];      /* of lines near it, whose edges are much the same */
    const uint8_t *ahead;          /* of one that comes soon */
    const ptrdiff_t *color_offset; /* bytes, per pixel of the line */
    float *near_z, *far_z;
    uint16_t *settled;
    ptrdiff_t step;   /* in pixels, of all planes but the colour's */
    ptrdiff_t across; /* to the same pixel of the next line */
    int32_t count;
    int32_t above, below; /* lines before and after this one */
    bool is_column;
} edge_matte_line;

/* Settles the edge between pixels i and i + 1 when it matters to bodies within `tile`. */
void edge_matte_settle(const edge_matte_line *line, int32_t i, const edge_matte_tile *tile,
                       int32_t reach);

/* ---- What a pixel on an edge is mixed of. A camera adds up light, not the codes of colours, so
 * shares are worked out in linear light; from the colours right beside the edge, since farther
 * away a surface has other shades. */

#define MIXTURE_NOISE 36.0f /* variance of a channel, sRGB steps squared */
#define MIXTURE_OFF_LINE                                                                           \
    0.6f /* squared distance of a colour from the line between the sides', in */
         /* squares of that line's length, that halves what it says */

typedef struct edge_matte_mixture {
    float far_light[3], difference[3]; /* near minus far, linear */
    float square;                      /* of the difference */
    float weight;                      /* of what the colours say, 0..1 */
} edge_matte_mixture;

/* Of the RGB of two unmixed pixels on each side, the nearer to the edge first. */
RLF_KERNEL_PART edge_matte_mixture edge_matte_mix(const uint8_t *const near_side[2],
                                                  const uint8_t *const far_side[2])
{
    edge_matte_mixture m = {.weight = 0.0f};
    float codes = 0.0f;
    for (int k = 0; k < 3; k++) {
        float near_light =
            0.75f * srgb_to_linear(near_side[0][k]) + 0.25f * srgb_to_linear(near_side[1][k]);
        m.far_light[k] =
            0.75f * srgb_to_linear(far_side[0][k]) + 0.25f * srgb_to_linear(far_side[1][k]);
        m.difference[k] = near_light - m.far_light[k];
        m.square += m.difference[k] * m.difference[k];
        float off = (float)(near_side[0][k] - far_side[0][k]);
        codes += off * off;
    }
    m.weight = m.square > 0.0f ? codes / (codes + MIXTURE_NOISE) : 0.0f;
    return m;
}

/* Share of the near side in a pixel of colour `c`; `unknown` as far as colours do not tell: where
 * the sides are much alike, or the colour is not mixed of those two. */
RLF_KERNEL_PART float edge_matte_share(const edge_matte_mixture *m, const uint8_t *c, float unknown)
{
    if (!(m->weight > 0.0f)) {
        return unknown;
    }
    float along = 0.0f;
    float length = 0.0f;
    for (int k = 0; k < 3; k++) {
        float from_far = srgb_to_linear(c[k]) - m->far_light[k];
        along += from_far * m->difference[k];
        length += from_far * from_far;
    }
    float share = along / m->square;
    const float strange = (length - share * along) / (m->square * MIXTURE_OFF_LINE);
    const float weight = m->weight / (1.0f + strange * strange);
    share = share < 0.0f ? 0.0f : (share > 1.0f ? 1.0f : share);
    return unknown + weight * (share - unknown);
}

/* ---- What the parts of a matte's update share. */

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
