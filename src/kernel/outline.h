/* Normals of pixels at the outlines of things, sixteen at a time: see surface/normals/outline.c. */
#ifndef RLF_KERNEL_OUTLINE_H
#define RLF_KERNEL_OUTLINE_H

#include "kernel/batch.h"

/* What is behind a pixel's outline lies farther by this share of the depth, or by a step of the
 * smaller share (an arm before a trunk) and what the pixel's own surface rises on the other side:
 * a slope goes on. What was filled is less sure of its depth than what was seen. */
#define RLF_OUTLINE_JUMP 0.03f
#define RLF_OUTLINE_STEP_SEEN 0.01f
#define RLF_OUTLINE_STEP_FILLED 0.02f
#define RLF_OUTLINE_STEPS 5 /* on the way in */

/* What lies farther than that is behind the outline of a pixel at that depth, and `rise` behind
 * what is on its other side. */
RLF_KERNEL_PART float rlf_outline_behind(float depth, float step, float rise)
{
    float sloped = step * depth + (rise > 0.0f ? rise : 0.0f), most = RLF_OUTLINE_JUMP * depth;
    return depth + (sloped < most ? sloped : most);
}

/* Where the outline is, seen from each pixel in front of it. */
typedef struct rlf_outlines {
    float x[RLF_BATCH], y[RLF_BATCH]; /* unit, outwards */
    float distance[RLF_BATCH];        /* pixels; 0 = nothing is behind the pixel */
} rlf_outlines;

typedef struct rlf_normals {
    float x[RLF_BATCH], y[RLF_BATCH], z[RLF_BATCH];
} rlf_normals;

/* `step`: RLF_OUTLINE_STEP_SEEN or _FILLED. */
void rlf_kernel_outline_find(const rlf_windows *restrict depth, float step,
                             rlf_outlines *restrict out);

/* ---- way_in.c ---- */

/* Planes that are read on the way. */
typedef struct rlf_way {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const uint8_t *known; /* 1 where depth was not filled */
    float *const *normal;
} rlf_way;

/* What is read at pixel (x, y) itself is brought near. */
RLF_KERNEL_PART void rlf_way_fetch(const rlf_way *way, int32_t x, int32_t y)
{
    ptrdiff_t i = (ptrdiff_t)y * way->width + x;
    RLF_KERNEL_SOON(&way->ray_x[i]);
    RLF_KERNEL_SOON(&way->ray_y[i]);
    for (int32_t k = 0; k < 3; k++) {
        RLF_KERNEL_SOON(&way->normal[k][i]);
    }
}

/* Pixels and what they see of their outlines. */
typedef struct rlf_way_from {
    int32_t x[RLF_BATCH], y[RLF_BATCH];
    rlf_outlines outline;
} rlf_way_from;

/* Of pixels whose windows show no outline, the one that is within RLF_NEAR_EDGE_APART pixels of
 * them. They are that far inside of the image. */
void rlf_kernel_outline_apart(const rlf_way *way, const rlf_way_from *restrict from,
                              rlf_outlines *restrict out);

/* What is known on the way in from an outline, step by step. */
typedef struct rlf_way_in {
    float ray_x[RLF_BATCH], ray_y[RLF_BATCH]; /* of the pixels themselves */
    float s[RLF_OUTLINE_STEPS][RLF_BATCH];    /* pixels from the outline */
    float moves[RLF_BATCH];                   /* 1 where something moves, else 0 */
    rlf_normals normal[RLF_OUTLINE_STEPS];    /* 0 = none */
} rlf_way_in;

/* Writes samples from the pixels inwards, the first so many steps in, as far as the surface goes
 * on, and the last pixel that is still of it; not whether it moves. */
void rlf_kernel_way_in(const rlf_way *way, const rlf_way_from *restrict from, int32_t first_step,
                       rlf_way_in *restrict in, int32_t *restrict inner);

/* ---- outline_turn.c ---- */

/* Normals of what turns steadily outwards, as something rounded does: 0 where it does not. `aside`
 * is the direction that is square to the ray and points outwards. */
void rlf_kernel_outline_round(const rlf_outlines *restrict at, const rlf_way_in *restrict in,
                              rlf_normals *restrict out, rlf_normals *restrict aside);

/* ---- near_edge_row.c ---- */

enum {
    RLF_NEAR_EDGE_APART = 4,
    RLF_NEAR_EDGE_ASLANT = 3
}; /* pixels; rows and columns, diagonals */

/* Of planes of that width, from the beginning of a row on; what is asked for is at least APART
 * pixels inside of them. Writes 1 where a pixel was seen or recalled (`known`) and something was in
 * front of the background there or APART pixels aside a frame ago, else 0. */
void rlf_kernel_was_front_row(const uint8_t *front, const uint8_t *known, ptrdiff_t width,
                              int32_t begin, int32_t end, uint8_t *restrict out);
/* Takes away marks (0 or 1) of pixels that nothing is behind so many pixels aside. */
void rlf_kernel_near_edge_row(const float *depth, ptrdiff_t width, int32_t begin, int32_t end,
                              uint8_t *restrict mark);

/* Normals of pixels near an outline that were seen, the first sample being the pixel itself: 0
 * where what is about them does not turn steadily outwards, unless it is right beside the outline
 * and not flat. */
void rlf_kernel_outline_near(const rlf_outlines *restrict at, const rlf_way_in *restrict in,
                             rlf_normals *restrict out);

/* The known normals within RLF_WINDOW_ABOUT pixels, row by row; 0 = none at the pixel's own depth.
 */
/* Where they are those of several faces and the outermost of them is turned outwards: that one.
 * Otherwise, of what is rounded (1, else 0), their mean turned a little outwards, or 0. */
void rlf_kernel_outline_face(const rlf_outlines *restrict at, const rlf_normals *restrict aside,
                             const rlf_normals *restrict window, const float *restrict rounded,
                             rlf_normals *restrict out);

#endif
