/* Contacts between two bodies. */
#ifndef RLF_PHYSICS_PAIR_COLLIDE_H
#define RLF_PHYSICS_PAIR_COLLIDE_H

#include "kernel/sat_lanes.h"
#include "physics/body.h"

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

#endif
