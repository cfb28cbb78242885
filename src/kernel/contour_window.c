/* Where a region ends, and how much of a window it fills. */
#include "kernel/flow.h"

enum { LANES = RLF_CONTOUR_SIDE + 1, CHUNK = 256, LEFT = 1, RIGHT = 2, ABOVE = 4, BELOW = 8 };

/* On which sides of pixels i .. i + size - 1 something lies behind them. */
RLF_KERNEL_PART void find_behind(const rlf_kernel_contour_in *in, int32_t i, int32_t size,
                                 int32_t *restrict sides)
{
    const float *restrict at = in->depth + i;
    const float *restrict up = at - in->width;
    const float *restrict down = at + in->width;
    float least = in->least;
    for (int32_t k = 0; k < size; k++) {
        float behind = at[k] + least;
        int32_t left = at[k - 1] > behind ? LEFT : 0, right = at[k + 1] > behind ? RIGHT : 0;
        int32_t above = up[k] > behind ? ABOVE : 0, below = down[k] > behind ? BELOW : 0;
        sides[k] = left | right | above | below;
    }
}

RLF_KERNEL void rlf_kernel_contour_row(const rlf_kernel_contour_in *in, int32_t count,
                                       uint8_t *restrict is_contour)
{
    int32_t sides[CHUNK];
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK;
        find_behind(in, first, size, sides);
        const uint8_t *restrict front = in->foreground + first;
        const uint8_t *restrict up = front - in->width;
        const uint8_t *restrict down = front + in->width;
        for (int32_t k = 0; k < size; k++) { /* apart, because bytes make longer vectors */
            uint8_t left = front[k - 1] == 0 ? LEFT : 0, right = front[k + 1] == 0 ? RIGHT : 0;
            uint8_t above = up[k] == 0 ? ABOVE : 0, below = down[k] == 0 ? BELOW : 0;
            uint8_t background = (uint8_t)(left | right | above | below);
            is_contour[first + k] = (uint8_t)(background & (uint8_t)sides[k]);
        }
    }
}

RLF_KERNEL void rlf_kernel_contour_window(const int32_t *label, int32_t width, int32_t own,
                                          int32_t x, int32_t y, int32_t out[3])
{
    int32_t column[LANES] = {0}, down[LANES] = {0};
    int32_t first =
        x + RLF_CONTOUR_RADIUS + 1 < width ? 0 : 1; /* a lane more is read than counts */
    const int32_t *corner =
        label + (ptrdiff_t)(y - RLF_CONTOUR_RADIUS) * width + (x - RLF_CONTOUR_RADIUS - first);
    for (int32_t row = 0; row < RLF_CONTOUR_SIDE; row++) {
        const int32_t *restrict at = corner + (ptrdiff_t)row * width;
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < LANES; k++) {
            int32_t is = at[k] == own ? 1 : 0;
            column[k] += is;
            down[k] += is * (row - RLF_CONTOUR_RADIUS);
        }
    }
    int32_t count = 0, across = 0, along = 0;
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < LANES; k++) {
        int32_t step = k - first - RLF_CONTOUR_RADIUS;
        int32_t counts = (step >= -RLF_CONTOUR_RADIUS) & (step <= RLF_CONTOUR_RADIUS) ? -1 : 0;
        count += column[k] & counts;
        across += (column[k] & counts) * step;
        along += down[k] & counts;
    }
    out[0] = count;
    out[1] = across;
    out[2] = along;
}
