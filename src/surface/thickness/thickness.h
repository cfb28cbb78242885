/* Chords: straight cuts through the bodies of the foreground along lines of the image, and the
 * conic whose front each of them shows.
 *
 * A plane through the camera cuts a quadric (ball, ellipsoid, cylinder, cone) in a conic, and
 * inverse depth w keeps it one: at a point of the chord, l and r steps from its two ends, w =
 * middle + slope s +- ratio sqrt(l r),
 * + for the front, - for the back. The front is seen, so the three unknowns are a linear least
 * squares, and the back follows. */
#ifndef RLF_SURFACE_THICKNESS_THICKNESS_H
#define RLF_SURFACE_THICKNESS_THICKNESS_H

#include "kernel/kernel.h"
#include "surface/stage.h"

#include <math.h>

enum { RLF_CHORD_PARTS = 6, RLF_CHORDS_PER_LINE = 16 };

/* Visible pixels begin <= k < end of a chord, in steps along its line. */
typedef struct rlf_chord_part {
    int32_t begin, end;
} rlf_chord_part;

/* Weighted sums over the front of a chord, about its means. */
typedef struct rlf_chord_moments {
    float ss, hh, sh, sy, hy;
} rlf_chord_moments;

/* Depth of a body's middle, metres, and how well it is known, 1/m^2; 0 = not at all. */
typedef struct rlf_chord_middle {
    float depth, weight;
} rlf_chord_middle;

typedef struct rlf_chord {
    float begin, end; /* of the body, in steps; part of it may be hidden */
    float blur[2];    /* how well these are known, steps */
    float covered[2]; /* steps at these that something nearer hides, by guess */
    float metres;     /* per step, at the reference depth */
    float inverse;    /* of the reference depth */
    float noise;      /* variance of depth there, m^2 */
    float expected_slope, expected_ratio;
    int32_t label, part_count;
    bool is_of_people;
    rlf_chord_part part[RLF_CHORD_PARTS];
    float weight, s, h, y, yy; /* sum of weights, means, variance sum of y */
    rlf_chord_moments own, pooled, running;
    rlf_chord_middle seen, filtered; /* by the chord alone; with all lines before it */
    rlf_chord_middle beside;         /* by the lines on both sides, without its own */
} rlf_chord;

/* y = middle + slope s - ratio h, in metres about the reference depth. */
typedef struct rlf_conic {
    float middle, slope, ratio;
    float variance; /* of what is left of y, m^2 */
} rlf_conic;

/* Pixels whose depth differs by more show two bodies, be they a trunk and an arm on it. */
#define RLF_BODY_STEP_M 0.04f

/* Real bodies are not quite conics. */
#define RLF_SHAPE_ERROR_M 0.003f

/* Nothing is taken to be thinner, or thicker. */
#define RLF_THINNEST_M 0.02f
#define RLF_THICKEST_M 0.6f

/* Rows of the planes below are this much longer than the grid's: pixels below each other, a power
 * of two apart, would push each other out of the cache. */
enum { RLF_CHORD_PAD = 16 };

/* Side of the squares of pixels, from a block's corner, of which it is known whether any body is in
 * them: lines pass through the others in one step. */
enum { RLF_CHORD_SQUARE = 8 };

/* Planes of sums over the chords through each knot: weights, weighted middles and half thicknesses
 * in inverse depth. */
typedef struct rlf_solid {
    float *weight, *middle, *half;
} rlf_solid;

/* Lines lie `step` pixels apart, and cross at knots, the pixels whose column and row are multiples
 * of it: thickness is smooth, its ends are as sharp as pixels. */
typedef struct rlf_chord_job {
    const rlf_reconstruct *stage;
    const rlf_slot *slot;
    bool is_of_people;       /* what bodies are usually like counts: else things */
    const float *raw;        /* depth that is fitted: as the sensor gave it */
    const float *behind;     /* nothing reaches farther; NULL = nothing is known to be there */
    const int32_t *is_plate; /* of each region, from 1: it is flat up to noise and has no chords */
    int32_t step;
    ptrdiff_t pitch;         /* of the planes of pixels: the grid's width and RLF_CHORD_PAD */
    float *front;            /* depth of the bodies' pixels, 0 elsewhere */
    float *inverse;          /* 1 / depth as the sensor gave it, 0 = none; of the bodies' pixels */
    int32_t *label;          /* of the bodies' pixels */
    uint8_t *squares;        /* of the block: 1 = a body is in it; rows of */
    int32_t square_pitch;    /* so many */
    int32_t columns, rows;   /* of knots */
    ptrdiff_t knot_pitch;    /* of the planes of knots: columns and RLF_CHORD_PAD */
    float *knot, *thickness; /* at the knots; depth < 0 is of what is no body */
    rlf_solid own, hidden;   /* the knot's own body, and one that it hides */
    rlf_chord *chords;       /* RLF_CHORDS_PER_LINE per line */
    int32_t *counts;         /* chords of each line */
    rlf_kernel_noise noise;
    int32_t x0, y0, width, height; /* the block of pixels */
    int32_t dx, dy;                /* step of the lines; dx >= 0 */
} rlf_chord_job;

/* Pixels base + k stride, 0 <= k < count; those of `phase` and every step-th one beyond are the
 * knots knot, knot + knot_stride and so on. */
typedef struct rlf_line {
    int32_t x, y, dx, dy;
    ptrdiff_t base, stride;
    ptrdiff_t knot, knot_stride;
    int32_t count, phase;
    float angle; /* metres per step at a depth of 1 m */
} rlf_line;

/* ---- thickness/thickness.c ---- */
/* For the regions of the slot's foreground that are in work.runs; work.map says which are plates.
 */
rlf_chord_job rlf_chord_job_make(rlf_reconstruct *stage, const rlf_slot *slot, const float *raw);
/* The region's pixels and the knots around. */
rlf_rect rlf_block_of(const image_grid *grid, const rlf_region *region, int32_t step);
/* Fits what is in the block, and writes the thickness of all runs. */
void rlf_thickness_fit(rlf_chord_job *job, const rlf_rect *block);
void rlf_thickness_write(const rlf_chord_job *job);

/* ---- thickness/knots.c ---- */
/* Pixels from knot to knot: one, or two where they are fine. */
int32_t rlf_knot_step(const image_grid *grid);
/* Fills the planes of the block's pixels. */
void rlf_chords_prepare(rlf_chord_job *job);
/* Thickness of the run's pixels from that of the knots around. */
void rlf_knots_spread(const rlf_chord_job *job, const rlf_run *run, int32_t y);
int32_t rlf_line_count(const rlf_chord_job *job);
rlf_line rlf_line_at(const rlf_chord_job *job, int32_t index);
/* Steps from the block's corner along the lines to the line's first pixel. */
float rlf_line_origin(const rlf_chord_job *job, int32_t index);

/* ---- thickness/cut.c ---- */
/* Finds the chords of the line and measures them. Returns their number. */
int32_t rlf_chords_cut(const rlf_chord_job *job, const rlf_line *line, rlf_chord *out);

/* ---- thickness/conic.c ---- */
/* Fills the sums of a chord whose ends and parts are known; false when it shows nothing. */
bool rlf_chord_measure(const rlf_chord_job *job, const rlf_line *line, rlf_chord *chord);
rlf_conic rlf_chord_solve(const rlf_chord *chord, const rlf_chord_moments *moments);
/* What the pooled sums of the chord say about its middle. */
rlf_chord_middle rlf_chord_middle_seen(const rlf_chord *chord);
/* Adds the solid of the conic to the knots of the chord. */
void rlf_chord_paint(const rlf_chord_job *job, const rlf_line *line, const rlf_chord *chord);

/* ---- thickness/static.c ---- */
/* One step of a round, if there is anything to do; after the frame's own thickness. */
void static_advance(rlf_reconstruct *stage);
/* The thickness of the newest image, metres along z, 0 = not known; NULL when it is not wanted or
 * there is no image. */
const float *static_newest(const rlf_reconstruct *stage);
void static_reset(static_thickness *state);

/* ---- thickness/static_pieces.c ---- */
/* One step, from 0, of finding the pieces of state->depth, whose normals are given; true when it
 * was the last. */
bool static_find_pieces(rlf_reconstruct *stage, float *const normal[3], int32_t step);

/* ---- thickness/static_box.c ---- */
typedef enum static_shape {
    STATIC_UNKNOWN = 0, /* one face, or no convex thing */
    STATIC_BOX,
    STATIC_ROUND /* no part of it is flat */
} static_shape;

/* axis[k] . p is from end[k][0] to end[k][1]; the first two axes are normals of faces that are
 * seen. An open end is cut by the border of the image: it may go on. Camera frame, metres. */
typedef struct static_box {
    rlf_vec3 axis[3];
    double end[3][2];
    bool is_open[3][2];
} static_box;

/* What the piece of state->depth is like; *out is written where it is a box. */
static_shape static_find_shape(const rlf_reconstruct *stage, float *const normal[3], int32_t piece,
                               static_box *out);
/* Depth at which the ray (x, y, 1) leaves the box that it has entered. */
double static_box_exit(const static_box *box, rlf_vec3 ray);

#endif
