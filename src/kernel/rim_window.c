/* Where a region ends, and how much of a window it fills. */
#include "kernel/flow.h"

enum { LANES = RLF_RIM_SIDE + 1 };

RLF_KERNEL void rlf_kernel_rim_row(const rlf_kernel_rim_in *in, int32_t own, int32_t count,
                                   uint8_t *restrict is_rim)
{
    const int32_t *restrict label = in->label;
    const float *restrict at = in->depth;
    const float *restrict up = at - in->width;
    const float *restrict down = at + in->width;
    const uint8_t *restrict front = in->foreground;
    const uint8_t *restrict front_up = front - in->width;
    const uint8_t *restrict front_down = front + in->width;
    float least = in->least;
    for (int32_t i = 0; i < count; i++) {
        float behind = at[i] + least;
        int32_t left = (front[i - 1] == 0) & (at[i - 1] > behind);
        int32_t right = (front[i + 1] == 0) & (at[i + 1] > behind);
        int32_t above = (front_up[i] == 0) & (up[i] > behind);
        int32_t below = (front_down[i] == 0) & (down[i] > behind);
        is_rim[i] = (uint8_t)((label[i] == own) & (left | right | above | below));
    }
}

RLF_KERNEL void rlf_kernel_rim_window(const int32_t *label, int32_t width, int32_t own, int32_t x,
                                      int32_t y, int32_t out[3])
{
    int32_t column[LANES] = {0}, down[LANES] = {0};
    int32_t first = x + RLF_RIM_RADIUS + 1 < width ? 0 : 1; /* a lane more is read than counts */
    const int32_t *corner =
        label + (ptrdiff_t)(y - RLF_RIM_RADIUS) * width + (x - RLF_RIM_RADIUS - first);
    for (int32_t row = 0; row < RLF_RIM_SIDE; row++) {
        const int32_t *restrict at = corner + (ptrdiff_t)row * width;
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < LANES; k++) {
            int32_t is = at[k] == own ? 1 : 0;
            column[k] += is;
            down[k] += is * (row - RLF_RIM_RADIUS);
        }
    }
    int32_t count = 0, across = 0, along = 0;
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < LANES; k++) {
        int32_t step = k - first - RLF_RIM_RADIUS;
        int32_t counts = (step >= -RLF_RIM_RADIUS) & (step <= RLF_RIM_RADIUS) ? -1 : 0;
        count += column[k] & counts;
        across += (column[k] & counts) * step;
        along += down[k] & counts;
    }
    out[0] = count;
    out[1] = across;
    out[2] = along;
}
