/* The side of an edge that a dropped pixel is on, as far as the colour picture tells: see
 * depth/color_guide.c. */
#ifndef RLF_SURFACE_DEPTH_COLOR_GUIDE_H
#define RLF_SURFACE_DEPTH_COLOR_GUIDE_H

#include "kernel/batch.h"
#include "base/arena.h"
#include "surface/frame.h"

/* How the colour picture lies beside depth at edges: see depth/color_guide.c. */
typedef struct rlf_color_sum {
    double square[9], value[3]; /* normal equations of the offset */
    double agree, asked;        /* pixels */
} rlf_color_sum;

typedef struct rlf_color_guide {
    rlf_image_rgba8 image; /* of the frame that is being made; data NULL = is not asked */
    bool can_tell;         /* the rig has a picture that shows what depth shows */
    float step[2][2];      /* colour pixels, of u and of v, per column and row of the grid */
    float reach;           /* colour pixels that are read about one */
    float offset[3];       /* pixels of the grid: columns, rows, and towards the nearer side */
    float trust;           /* 0..1 */
    rlf_color_sum sum;     /* of the frames before, older ones counting less */
    rlf_color_sum *part;   /* of this frame, per chunk of rows; NULL = colour is not wanted */
    int32_t parts;
} rlf_color_guide;

/* Columns and rows from a pixel to the next of a line of gap_patch.c. */
extern const int32_t rlf_line_step[RLF_LINE_NONE][2];

/* A dropped pixel between the two sides of an edge. */
typedef struct rlf_guide_cases {
    int32_t count;
    const int32_t *x, *y;
    const int32_t *line; /* RLF_LINE_, through the pixel and both ends of its gap */
    const rlf_gap_ends *ends;
    const rlf_windows *depth; /* about them */
    float *votes;             /* for the nearer side, less those for the farther one */
} rlf_guide_cases;

/* Takes the frame's picture; what follows does nothing without one. */
void rlf_color_guide_start(rlf_reconstruct *stage, const rlf_frame *frame);
/* Adds the votes of the picture to those of depth, where it may be asked and tells. What it shows
 * beside these is added to *sum: one of the stage's for each chunk of rows. */
void rlf_color_guide_vote(const rlf_reconstruct *stage, const rlf_guide_cases *c,
                          const bool may_ask[RLF_BATCH], rlf_color_sum *sum);
/* Learns from the chunks' sums how the picture is to be read from the next frame on. */
void rlf_color_guide_learn(rlf_reconstruct *stage);
void rlf_color_guide_reset(rlf_reconstruct *stage);
void color_guide_allocate(rlf_color_guide *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                          const image_grid *grid);

#endif
