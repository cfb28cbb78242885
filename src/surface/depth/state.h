/* What is kept of depth from frame to frame: means over time, what the colour picture tells of
 * edges, and where the sensor's shadow lies. */
#ifndef RLF_SURFACE_DEPTH_STATE_H
#define RLF_SURFACE_DEPTH_STATE_H

#include "base/arena.h"
#include "kernel/batch.h"
#include "surface/frame.h"

/* Side of a block in pixels, and the frames without motion after which one is calm. */
enum { RLF_TEMPORAL_BLOCK = 8, RLF_TEMPORAL_CALM = 8 };

/* Means of inverse depth over time; NULL planes when they are not wanted. */
typedef struct temporal {
    float *mean, *frames;
    uint8_t *calm;     /* per block of RLF_TEMPORAL_BLOCK pixels, frames since something moved */
    uint8_t *restless; /* per block: 1 where it, or one beside it, is not calm */
    int32_t age;       /* frames that were averaged, up to 255 */
    uint8_t *change;   /* plane, scratch of temporal_recall.c */
    int8_t *lag;       /* plane, scratch of temporal_mean.c */
} temporal;

void temporal_allocate(temporal *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                       const image_grid *grid);
void temporal_reset(temporal *state, const image_grid *grid);

/* ---- color_guide.c: the side of an edge that a dropped pixel is on, as far as the picture tells
 * ---- */

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

/* ---- shadow.c ---- */

/* The shadow that the sensor's projector leaves beside near things: see shadow.c. Two sides of a
 * thing: left, right. */
enum {
    RLF_SHADOW_BINS = 32,
    RLF_SHADOW_MIXED = 2 /* pixels at an edge that drivers drop without a shadow */
};

typedef struct rlf_shadow {
    float told[2][RLF_SHADOW_BINS]; /* by how many runs without depth, per baseline */
    float baseline[2];              /* metres; 0 = none there */
    bool is_known;                  /* enough was told */
    int32_t next_row;               /* the first that is asked next */
} rlf_shadow;

/* The side of a near thing on which it lies. */
typedef enum rlf_shadow_side { RLF_SHADOW_LEFT = 0, RLF_SHADOW_RIGHT = 1 } rlf_shadow_side;

void rlf_shadow_reset(rlf_shadow *shadow);
/* Reads some rows of a frame's depth as it was seen, before holes are filled. */
void rlf_shadow_learn(rlf_reconstruct *stage, const float *depth);
/* Pixels; while the sensor is not known, as wide as of any, on both sides. */
float rlf_shadow_width(const rlf_reconstruct *stage, rlf_shadow_side side, float near_z,
                       float far_z);

#endif
