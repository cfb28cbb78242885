/* How thick static things are: the background, piece by piece.
 *
 * Nobody sees the back of a chair that stands. But a round front bends, and a box shows two faces:
 * both say where the back is. What touches along a concave crease is two things (Stein, Schoeler,
 * Papon, Woergoetter 2014: object partitioning using local convexity): so a background falls into
 * locally convex pieces. Flat ones say nothing about their backs. One of the others is fitted per
 * frame, and a round over all of them is published as a whole. */
#ifndef RLF_SURFACE_THICKNESS_STATIC_H
#define RLF_SURFACE_THICKNESS_STATIC_H

#include "surface/stage.h"

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
