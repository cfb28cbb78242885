/* Boxes against a box, sixteen at a time. */
#include "kernel/lanes.h"
#include "kernel/kernel.h"

RLF_KERNEL int32_t rlf_kernel_boxes_meet(const float *restrict ends, int32_t stride, int32_t begin,
                                         int32_t end, const float box[6], int32_t *restrict found)
{
    const float *low_x = ends, *low_y = low_x + stride, *low_z = low_y + stride;
    const float *high_x = low_z + stride, *high_y = high_x + stride, *high_z = high_y + stride;
    int32_t count = 0;
    for (int32_t p = begin; p < end; p += RLF_BOX_LANES) {
        int32_t meets[RLF_BOX_LANES], any = 0;
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < RLF_BOX_LANES; k++) {
            meets[k] = (low_x[p + k] <= box[3]) & (low_y[p + k] <= box[4]) &
                       (low_z[p + k] <= box[5]) & (high_x[p + k] >= box[0]) &
                       (high_y[p + k] >= box[1]) & (high_z[p + k] >= box[2]);
            any |= meets[k];
        }
        int32_t rest = any == 0 ? 0 : end - p < RLF_BOX_LANES ? end - p : RLF_BOX_LANES;
        for (int32_t k = 0; k < rest; k++) {
            found[count] = p + k;
            count += meets[k];
        }
    }
    return count;
}

/* How far x is outside low to high. */
RLF_KERNEL_PART float outside(float x, float low, float high)
{
    float off = low - x > x - high ? low - x : x - high;
    return off > 0.0f ? off : 0.0f;
}

RLF_KERNEL void rlf_kernel_boxes_distance2(const float (*boxes)[6], int32_t count, const float *x,
                                           const float *y, const float *z,
                                           float *restrict distance2)
{
    float least[RLF_BOX_LANES];
    for (int32_t k = 0; k < RLF_BOX_LANES; k++) {
        least[k] = 1e30f;
    }
    for (int32_t i = 0; i < count; i++) {
        const float *box = boxes[i];
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < RLF_BOX_LANES; k++) {
            float dx = outside(x[k], box[0], box[3]);
            float dy = outside(y[k], box[1], box[4]);
            float dz = outside(z[k], box[2], box[5]);
            float square = dx * dx + dy * dy + dz * dz;
            least[k] = square < least[k] ? square : least[k];
        }
    }
    for (int32_t k = 0; k < RLF_BOX_LANES; k++) {
        distance2[k] = least[k];
    }
}
