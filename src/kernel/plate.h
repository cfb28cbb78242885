/* Boxes and the points of a row: see surface/plate/plate.h. */
#ifndef RLF_KERNEL_PLATE_H
#define RLF_KERNEL_PLATE_H

#include "kernel/kernel.h"

/* A box, camera frame, metres. */
typedef struct rlf_kernel_plate {
    float axis[3][3]; /* unit */
    float from[3];    /* the centre along each */
    float half[3];
} rlf_kernel_plate;

/* Where the rays (ray_x, ray_y, 1) leave the box: a depth, 0 for those that miss it or only meet it
 * behind the camera. 1 in is_near for the points at `depth` on them that are at most `reach` from
 * the box, else 0, as where depth is 0. */
void rlf_kernel_plate_row(const rlf_kernel_plate *plate, float reach, const float *restrict ray_x,
                          const float *restrict ray_y, const float *restrict depth, int32_t count,
                          float *restrict leave, int32_t *restrict is_near);

#endif
