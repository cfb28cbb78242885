/* Boxes side by side: which of them overlap one. Every clone gives the same bits. */
#ifndef RLF_KERNEL_BOX_LANES_H
#define RLF_KERNEL_BOX_LANES_H

#include <stdint.h>

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

#endif
