/* Contacts of eight groups at once: what the solver of physics does in its passes.
 *
 * A group is what touches between two bodies, or between a body and a surface. The groups in the
 * lanes of a batch share no body that moves, so the lanes do not meet. Values are floats in SI
 * units; every clone gives the same bits. */
#ifndef RLF_KERNEL_CONTACT_LANES_H
#define RLF_KERNEL_CONTACT_LANES_H

#include <stdbool.h>
#include <stdint.h>

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
