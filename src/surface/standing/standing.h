/* How thick what stands is: the background, piece by piece.
 *
 * Nobody sees the back of a chair that stands, but a ball's front bends, and a box shows two faces:
 * both say where the back is, as with what moves (thickness.h). What touches along a concave crease
 * is two things (Stein, Schoeler, Papon, Woergoetter 2014: object partitioning using local
 * convexity): so a background falls into locally convex pieces. Flat ones say nothing about their
 * backs. Of the others one per frame is fitted; when all are done, they are published together.
 *
 * Depth that differs from that which was fitted has no known thickness until the next round. */
#ifndef RLF_SURFACE_STANDING_STANDING_H
#define RLF_SURFACE_STANDING_STANDING_H

#include "surface/stage.h"

/* ---- standing/standing.c ---- */
/* One step of a round, if there is anything to do; after the frame's own thickness. */
void rlf_standing_advance(rlf_reconstruct *stage);
/* The thickness of the newest sheet, metres along z, 0 = not known; NULL when it is not wanted or
 * there is no sheet. */
const float *rlf_standing_newest(const rlf_reconstruct *stage);
void rlf_standing_reset(rlf_standing *standing);

/* ---- standing/pieces.c ---- */
/* One step, from 0, of finding the pieces of standing->depth, whose normals are given; true when it
 * was the last. Uses work.depth[0], mask[0], links, runs, component, size and map. */
bool rlf_standing_find_pieces(rlf_reconstruct *stage, float *const normal[3], int32_t step);

/* ---- standing/shape.c ---- */
typedef enum rlf_standing_shape {
    RLF_STANDING_UNKNOWN = 0, /* one face, or no convex thing */
    RLF_STANDING_BOX,
    RLF_STANDING_BALL,
    RLF_STANDING_ROUND /* no part of it is flat, and it is no ball */
} rlf_standing_shape;

/* Camera frame. A box has axis[k] . p from low[k] to high[k], the first two axes out of faces that
 * are seen. At an open end the border of the image cuts it: it may go on. */
typedef struct rlf_standing_solid {
    rlf_standing_shape shape;
    rlf_vec3 axis[3];
    double low[3], high[3];
    bool is_open_low[3], is_open_high[3];
    rlf_vec3 centre; /* of a ball */
    double radius;
} rlf_standing_solid;

/* What the piece of standing->depth is like. */
void rlf_standing_find_shape(const rlf_reconstruct *stage, float *const normal[3], int32_t piece,
                             rlf_standing_solid *out);
/* Depth at which the ray (x, y, 1) leaves the box or ball that it has entered. */
float rlf_standing_exit(const rlf_standing_solid *solid, double ray_x, double ray_y);

#endif
