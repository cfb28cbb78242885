/* Where depth jumps. */
#include "eval/measures/band.h"

#include <stdbool.h>
#include <stddef.h>

#define BAND_PIXELS 6
#define JUMP_SHARE 0.04

static bool is_jump(float a, float b)
{
    float near = a < b ? a : b;
    float step = a < b ? b - a : a - b;
    return near > 0.0f && step > (float)JUMP_SHARE * near;
}

/* Square dilation by BAND_PIXELS along one axis. */
static void dilate(const uint8_t *in, uint8_t *out, int32_t count, int32_t step)
{
    int32_t last = -BAND_PIXELS - 1;
    for (int32_t i = 0; i < count; i++) {
        last = in[i * step] ? i : last;
        out[i * step] = i - last <= BAND_PIXELS;
    }
    last = count + BAND_PIXELS;
    for (int32_t i = count - 1; i >= 0; i--) {
        last = in[i * step] ? i : last;
        out[i * step] |= last - i <= BAND_PIXELS;
    }
}

void eval_mark_band(const float *depth, int32_t width, int32_t height, uint8_t *out,
                    uint8_t *scratch)
{
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            int32_t i = y * width + x;
            bool right = x + 1 < width && is_jump(depth[i], depth[i + 1]);
            bool left = x > 0 && is_jump(depth[i], depth[i - 1]);
            bool below = y + 1 < height && is_jump(depth[i], depth[i + width]);
            bool above = y > 0 && is_jump(depth[i], depth[i - width]);
            out[i] = right || left || below || above;
        }
    }
    for (int32_t y = 0; y < height; y++) {
        dilate(out + (ptrdiff_t)y * width, scratch + (ptrdiff_t)y * width, width, 1);
    }
    for (int32_t x = 0; x < width; x++) {
        dilate(scratch + x, out + x, height, width);
    }
}
