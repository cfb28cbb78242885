/* Lanes side by side: what physics does for eight pairs or groups at once. Every clone gives the
 * same bits. */
#ifndef RLF_KERNEL_LANES_H
#define RLF_KERNEL_LANES_H

#include <stdbool.h>
#include <stdint.h>

/* ---- box_lanes.c: boxes side by side: which of them overlap one. Every clone gives the same
 * bits. */

#define RLF_BOX_LANES 16

/* Where boxes begin and end: `ends` holds low x, y, z and high x, y, z, each a row of `stride`
 * floats that goes on for RLF_BOX_LANES after the last box. Writes to `found` those of the boxes
 * from `begin` to `end` (excluded) that overlap or touch the box of the same six numbers, in their
 * order, and returns their number; `found` has room for one more than there are boxes. */
int32_t rlf_kernel_boxes_meet(const float *restrict ends, int32_t stride, int32_t begin,
                              int32_t end, const float box[6], int32_t *restrict found);

/* Squares of the distances of sixteen points to the nearest of `count` boxes, m^2: 1e30 when there
 * are none. A box is low x, y, z and high x, y, z. */
void rlf_kernel_boxes_distance2(const float (*boxes)[6], int32_t count, const float *x,
                                const float *y, const float *z, float *restrict distance2);

/* ---- sat_lanes.c: separating axes of eight pairs of boxes at once (Gottschalk, Lin and Manocha
 * 1996). Doubles; every clone gives the same bits. */

#define RLF_SAT_LANES 8

/* Pairs of boxes, metres. */
typedef struct rlf_sat_pairs {
    double axis_a[3][3][RLF_SAT_LANES]; /* a's axes, each by its x, y, z */
    double axis_b[3][3][RLF_SAT_LANES];
    double half_a[3][RLF_SAT_LANES], half_b[3][RLF_SAT_LANES];
    double way[3][RLF_SAT_LANES];    /* from b's centre to a's */
    double margin[RLF_SAT_LANES];    /* beyond which edges are not asked */
    double edge_gain[RLF_SAT_LANES]; /* an edge must be better than a face by so much */
} rlf_sat_pairs;

typedef struct rlf_sat_axes {
    double gap[RLF_SAT_LANES];           /* along the best face's normal; below 0: they overlap */
    double code[RLF_SAT_LANES];          /* 0..2 a's face, 3..5 b's */
    double sign[RLF_SAT_LANES];          /* -1 where that normal points from a to b, else 1 */
    double edges[RLF_SAT_LANES];         /* bit 3 i + k: a's edge i and b's edge k may be better */
    double edge_gap[9][RLF_SAT_LANES];   /* along their cross product, as long as it is */
    double edge_along[9][RLF_SAT_LANES]; /* the way along it */
    double cosine[9][RLF_SAT_LANES];     /* between the two edges */
} rlf_sat_axes;

/* The best of the faces, and which edges have to be looked at: none where a face shows a gap above
 * the margin. A later face must be better by a micrometre. */
void rlf_kernel_sat_find(const rlf_sat_pairs *restrict pairs, rlf_sat_axes *restrict axes);

/* ---- contact_lanes.c: contacts of eight groups at once: what the solver of physics does in its
 * passes. A group is what touches between two bodies, or between a body and a surface. The
 * groups in the lanes of a batch share no body that moves, so the lanes do not meet. Values are
 * floats in SI units; every clone gives the same bits. */

#define RLF_LANES 8

/* Velocity of a body's centre, then its angular velocity; the world's axes. The last two are not
 * used: so it is one load. */
typedef struct rlf_lane_speed {
    float of[8];
} rlf_lane_speed;

typedef struct rlf_lane_vec {
    float x[RLF_LANES], y[RLF_LANES], z[RLF_LANES];
} rlf_lane_vec;

/* Symmetric matrices. */
typedef struct rlf_lane_mat {
    float xx[RLF_LANES], xy[RLF_LANES], xz[RLF_LANES];
    float yy[RLF_LANES], yz[RLF_LANES], zz[RLF_LANES];
} rlf_lane_mat;

/* One touching point in each lane; all zero where a lane has none. */
typedef struct rlf_lane_point {
    rlf_lane_vec normal;        /* unit, from b or the surface to a */
    rlf_lane_vec tangent;       /* unit; the second tangent is normal x tangent */
    rlf_lane_vec r_a;           /* from a's centre to the point, m */
    rlf_lane_vec r_b;           /* from b's centre; of a surface: its velocity there, m/s */
    float mass[3][RLF_LANES];   /* effective, along the normal and the tangents, kg */
    float target[2][RLF_LANES]; /* least speed along the normal, m/s: at rest, and with push */
    float ease[RLF_LANES];      /* with push: 1 / (1 + a2) of a soft contact, 0 of a rigid one */
    float friction[RLF_LANES];
    float impulse[3]
                 [RLF_LANES]; /* along the normal and the tangents, N s; kept from pass to pass */
} rlf_lane_point;

typedef struct rlf_lane_batch {
    rlf_lane_point *points;
    int32_t point_count;
    bool has_b;                         /* false: the groups are of surfaces */
    int32_t a[RLF_LANES], b[RLF_LANES]; /* indices of speeds; any valid one in an empty lane */
    float inverse_mass_a[RLF_LANES];    /* 1/kg; 0 of what does not move, and in an empty lane */
    float inverse_mass_b[RLF_LANES];
    rlf_lane_mat inverse_inertia_a; /* world; 0 likewise */
    rlf_lane_mat inverse_inertia_b;
} rlf_lane_batch;

/* Fills in the points' masses. */
void rlf_kernel_lanes_weigh(const rlf_lane_batch *batch);

/* Gives the bodies the impulses that the points hold. */
void rlf_kernel_lanes_push(const rlf_lane_batch *batch, rlf_lane_speed *speeds);

/* One pass of sequential impulses: along the normals, then within the cones of friction. With
 * `push` the second target counts. excess[lane] is positive where an impulse changed a point's
 * speed by more than `settled`, m/s. */
void rlf_kernel_lanes_solve(const rlf_lane_batch *batch, rlf_lane_speed *speeds, bool push,
                            float settled, float excess[RLF_LANES]);

/* The same for two batches that share no body that moves, and of which both or none are of
 * surfaces. */
void rlf_kernel_lanes_solve_two(const rlf_lane_batch *const batches[2], rlf_lane_speed *speeds,
                                bool push, float settled, float excess[2][RLF_LANES]);

#endif
