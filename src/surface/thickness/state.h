/* What is kept of thickness: of static things, and the planes of chords. */
#ifndef RLF_SURFACE_THICKNESS_STATE_H
#define RLF_SURFACE_THICKNESS_STATE_H

#include "base/arena.h"
#include "surface/frame.h"

/* One published state of the background. It never changes while a surface refers to it. */
typedef struct background_image {
    float *depth;
    float *normal[3];
    int32_t *label;
    rlf_region *regions;
    int32_t *region_points;
    int32_t region_count, point_count;
    int32_t version;
} background_image;

/* Surfaces refer to at most RLF_RECONSTRUCT_SURFACES images while the next one is made. */
enum { BACKGROUND_IMAGES = RLF_RECONSTRUCT_SURFACES + 1 };

/* A image is made in tiles of so many pixels on a side. */
enum { BACKGROUND_TILE = 104 };

/* At most so many pieces of the background are looked at. */
enum { RLF_PIECES = 255 };

/* The thickness of static things: see thickness/static.c; NULL planes when it is not wanted. */
typedef struct static_thickness {
    float *depth, *thickness;            /* planes: what is fitted in this round, and found */
    float *done_depth, *done;            /* the same of the last round that came to its end */
    float *published[BACKGROUND_IMAGES]; /* planes: `done` where the newest image has that depth */
    uint8_t *piece;                      /* plane: of which piece; 0 = of none */
    float *smooth;                       /* plane, scratch: depth off creases */
    uint8_t *before;                     /* plane, scratch */
    rlf_rect window[RLF_PIECES + 1];     /* of each piece, from 1; empty = it is not looked at */
    int32_t piece_count, next_piece;     /* next_piece 0: they are still being found ... */
    int32_t step;                        /* ... in this step */
    bool is_round;                       /* one goes on */
    int32_t rounds, round_age; /* begun so far, up to a few; frames since the last began */
    int32_t newest;            /* of `published`; -1 = none */
    int32_t publications;      /* so far; never less than before */
    int32_t image_version;     /* of the image that it was published for */
    int32_t changed;           /* pixels of that image that are not as they were fitted */
} static_thickness;

bool static_is_wanted(const rlf_reconstruct_def *def);
void static_allocate(static_thickness *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                     const image_grid *grid);

/* Planes of the chords, padded rows, see thickness.h; NULL when thickness is not wanted. */
typedef struct chord_planes {
    float *knot;
    float *solid[6];                    /* own and hidden */
    struct rlf_chord *chord;            /* of the lines in one direction */
    uint8_t *squares;                   /* of pixels */
    float *front, *inverse, *thickness; /* scratch */
    int32_t *label;                     /* scratch */
} chord_planes;

void chords_allocate(chord_planes *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                     const image_grid *grid);

#endif
