/* Kernels of what moves: where it is a little later, and how far it came since the frame before. */
#ifndef RLF_KERNEL_FLOW_H
#define RLF_KERNEL_FLOW_H

#include "kernel/kernel.h"

/* ---- move_row.c: where what moves is a little later
 * --------------------------------------------- */

typedef struct rlf_kernel_motion {
    float dt;              /* s */
    float fx, fy;          /* pixels: the step in the image is measured with them */
    float least_z;         /* metres: nothing comes nearer */
    int32_t width, height; /* of the image */
} rlf_kernel_motion;

/* A point in metres and its pixel. */
typedef struct rlf_kernel_point {
    float x, y, z, u, v;
} rlf_kernel_point;

/* The point after dt, with a velocity in m/s. */
RLF_KERNEL_PART rlf_kernel_point rlf_kernel_move(const rlf_kernel_motion *m, rlf_kernel_point p,
                                                 float vx, float vy, float vz)
{
    float x = p.x / p.z, y = p.y / p.z;
    p.x += vx * m->dt;
    p.y += vy * m->dt;
    p.z += vz * m->dt;
    p.z = p.z > m->least_z ? p.z : m->least_z;
    p.u += (p.x / p.z - x) * m->fx;
    p.v += (p.y / p.z - y) * m->fy;
    return p;
}

/* Pixel of the point, < 0 out of view. */
RLF_KERNEL_PART int32_t rlf_kernel_pixel_of(const rlf_kernel_motion *m, const rlf_kernel_point *p)
{
    bool is_inside = (p->u > -0.5f) & (p->v > -0.5f) & (p->u < (float)m->width - 0.5f) &
                     (p->v < (float)m->height - 0.5f);
    float u = is_inside ? p->u + 0.5f : 0.0f, v = is_inside ? p->v + 0.5f : 0.0f;
    return is_inside ? (int32_t)v * m->width + (int32_t)u : -1;
}

/* From pixel (x, y) on. */
typedef struct rlf_kernel_moving_row {
    const uint8_t *foreground;
    const float *depth, *ray_x, *ray_y, *velocity[3];
    int32_t x, y, count;
} rlf_kernel_moving_row;

/* Where each pixel of the foreground that moves is after dt: its depth, and its pixel if `seen`,
 * a plane of the image, has no depth there; else, and for all other pixels, to = -1. */
void rlf_kernel_move_row(const rlf_kernel_motion *motion, const rlf_kernel_moving_row *in,
                         const float *restrict seen, float *restrict z, int32_t *restrict to);

/* ---- flow_batch.c: samples of a surface, a frame ago, see surface/motion/cells.c
 * --------------------------------------------------- */

#define RLF_FLOW_BATCH 64 /* most samples */
#define RLF_FLOW_LANES 16 /* samples that are best looked at together */

/* Depth where something that may move was seen, 0 elsewhere. */
void rlf_kernel_front_row(const float *restrict depth, const uint8_t *restrict reason,
                          const uint8_t *restrict front, int32_t count, float *restrict out);

/* A frame: planes of seen depth (see above) and of rays; focal lengths in pixels. */
typedef struct rlf_kernel_flow_view {
    const float *seen, *ray_x, *ray_y;
    int32_t width, height;
    float fx, fy;
    float limb; /* metres: farther pixels are another limb */
} rlf_kernel_flow_view;

/* Points, their unit normals, pixels and rays. */
typedef struct rlf_kernel_flow_samples {
    float x[RLF_FLOW_BATCH], y[RLF_FLOW_BATCH], z[RLF_FLOW_BATCH];
    float nx[RLF_FLOW_BATCH], ny[RLF_FLOW_BATCH], nz[RLF_FLOW_BATCH];
    float column[RLF_FLOW_BATCH], row[RLF_FLOW_BATCH];
    float ray_x[RLF_FLOW_BATCH], ray_y[RLF_FLOW_BATCH];
} rlf_kernel_flow_samples;

/* Of samples first .. first + count - 1, taken back by `step` metres: distance along the normal
 * from what the frame saw there, and whether it saw their limb; as many in the arrays. */
void rlf_kernel_flow_residuals(const rlf_kernel_flow_view *view,
                               const rlf_kernel_flow_samples *samples, const float step[3],
                               int32_t first, int32_t count, float *restrict out,
                               int32_t *restrict is_seen);

/* ---- flow_row.c: velocity of pixels, see surface/motion/cells.c
 * --------------------------------------------------- */

/* A rigid motion: m/s at the centre (metres), radians per second. */
typedef struct rlf_kernel_twist {
    double centre[3], linear[3], spin[3];
} rlf_kernel_twist;

typedef struct rlf_kernel_flow_cell {
    float velocity[3], depth;
    bool is_known, is_whole; /* whole: it moves with the twist */
} rlf_kernel_flow_cell;

/* Pixels between the middles of four cells: above left and right, below left and right. */
typedef struct rlf_kernel_flow {
    rlf_kernel_flow_cell cell[4];
    rlf_kernel_twist twist;
    bool moves;          /* the twist is not 0 */
    int32_t first;       /* the first pixel, from the first cell's left */
    float inverse;       /* cells per pixel */
    float column;        /* of the left cells */
    float down;          /* share of the way from the upper cells' middles to the lower ones' */
    float limb, fastest; /* metres: farther cells are another limb; m/s: no more is written */
} rlf_kernel_flow;

/* Velocities of `count` pixels from the cells with their limb, by nearness. */
void rlf_kernel_flow_row(const rlf_kernel_flow *restrict flow, const float *restrict depth,
                         const float *restrict ray_x, const float *restrict ray_y, int32_t count,
                         float *const velocity[3]);

#endif
