/* Contacts between two bodies. */
#ifndef RLF_PHYSICS_PAIR_COLLIDE_H
#define RLF_PHYSICS_PAIR_COLLIDE_H

#include "kernel/lanes.h"
#include "physics/body.h"
#include "physics/world_state.h"
#include "relief/math.h"

/* A touching point in the making: world frame, normal from b to a. */
typedef struct pair_point {
    rlf_vec3 core_a,
        core_b; /* the surface points are core_a - rounding_a n, core_b + rounding_b n */
    double rounding_a, rounding_b;
    rlf_vec3 normal;
    double separation;
} pair_point;

#define PAIR_POINTS_MAX 64

/* Puts a pair into a lane, where its separating axes are looked for. Of other shapes than boxes
 * what is found means nothing. */
void pair_boxes_load(const phys_body *a, const phys_body *b, double margin, int32_t lane,
                     rlf_sat_pairs *out);

/* Points closer than margin; returns their number (box-box: at most 16). Boxes, whose axes are
 * those of a lane, set *out_gap to a bound below their distance, negative when they overlap, and
 * *out_side where there are points. */
int32_t pair_collide_boxes(const phys_body *a, const phys_body *b, double margin,
                           const rlf_sat_axes *axes, int32_t lane, pair_point *out, double *out_gap,
                           phys_side *out_side);

/* The same for other shapes, the points of pair_collide_convex for all but balls and two capsules.
 * Sets *out_gap where it is known. */
int32_t pair_collide_shapes(const phys_body *a, const phys_body *b, double margin, pair_point *out,
                            double *out_gap);

/* Any two convex shapes but two of which neither has a volume but its rounding. */
int32_t pair_collide_convex(const phys_body *a, const phys_body *b, double margin, pair_point *out,
                            double *out_gap);

/* Chooses up to PHYS_PAIR_CONTACTS of them that give the widest support; returns their number. */
int32_t pair_reduce(const pair_point *points, int32_t count, double radius,
                    int32_t chosen[PHYS_PAIR_CONTACTS]);

/* ---- search.c: the pairs of bodies that are near each other, and their contacts. */

#define PHYS_PAIR_MARGIN 0.002 /* m beyond their way at which bodies are near */

/* Finds the pairs and searches the contacts of those that have moved. h: substep, s. Pairs live on
 * for PHYS_PERIOD_MAX substeps. */
void phys_find_pairs(rlf_world *world, double h);

/* Counts a substep and searches anew the contacts of fast pairs. */
void phys_refresh_pairs(rlf_world *world, double h);

/* Takes away the pairs of a body. */
void phys_drop_pairs(rlf_world *world, int32_t body);

/* ---- broad_phase.c: which bodies are near each other. */

/* Fills world->near_sorted, sorted by (a, b), with the bodies whose boxes may overlap within
 * `horizon` seconds; not those of which neither moves. */
void phys_find_near(rlf_world *world, double horizon);

/* ---- face.c: the faces with which bodies touch. */

/* A hull's face with more corners keeps some of them, evenly. */
#define PAIR_FACE_MAX 16

/* What of a body's core is outermost in a direction, world frame: nothing (0 corners), the 2 of an
 * edge, or a convex polygon, counter-clockwise seen from outside. */
typedef struct pair_face {
    rlf_vec3 corner[PAIR_FACE_MAX];
    int32_t count;
    rlf_vec3 normal; /* unit, outward; of polygons */
    double rounding; /* the surface is so far outside of the corners, metres */
} pair_face;

/* The face that looks most along the unit direction `out`, whether it touches or not. */
void pair_face_of(const phys_body *body, rlf_vec3 out, pair_face *face);

/* ---- Cutting polygons with planes. */

/* Sutherland and Hodgman 1974: keeps the part of a convex polygon with n.p <= d; of two corners, a
 * segment's. Returns the corners left: one more than before at most, but where rounding makes
 * corners in a line lie on both sides, half as many more. */
static inline int32_t pair_clip(const rlf_vec3 *in, int32_t count, rlf_vec3 n, double d,
                                rlf_vec3 *out)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 p = in[i], q = in[i + 1 < count ? i + 1 : 0];
        double dp = rlf_dot(n, p) - d, dq = rlf_dot(n, q) - d;
        if (dp <= 0.0) {
            out[kept++] = p;
        }
        if ((dp < 0.0 && dq > 0.0) || (dp > 0.0 && dq < 0.0)) {
            out[kept++] = rlf_mad(p, rlf_sub(q, p), dp / (dp - dq));
        }
    }
    return kept;
}

#endif
