/* Kernels of what moves: how far it came since the frame before. */
#ifndef RLF_KERNEL_FLOW_H
#define RLF_KERNEL_FLOW_H

#include "kernel/kernel.h"

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
