/* Three bytes of a pixel to four and back: the copies that every picture of a network pays. All but
 * the last pixel go as four bytes; the one too many is set right at once. */
#include "io/picture/pixels.h"

#include <string.h>

void io_rgb_to_rgba(const uint8_t *rgb, int32_t width, uint8_t *out_rgba)
{
    for (int32_t x = 0; x + 1 < width; x++) {
        memcpy(out_rgba + (ptrdiff_t)4 * x, rgb + (ptrdiff_t)3 * x, 4);
        out_rgba[4 * x + 3] = 255;
    }
    if (width > 0) {
        memcpy(out_rgba + (ptrdiff_t)4 * (width - 1), rgb + (ptrdiff_t)3 * (width - 1), 3);
        out_rgba[4 * width - 1] = 255;
    }
}

void io_rgba_to_rgb(const uint8_t *rgba, int32_t width, uint8_t *out_rgb)
{
    for (int32_t x = 0; x + 1 < width; x++) {
        memcpy(out_rgb + (ptrdiff_t)3 * x, rgba + (ptrdiff_t)4 * x, 4);
    }
    if (width > 0) {
        memcpy(out_rgb + (ptrdiff_t)3 * (width - 1), rgba + (ptrdiff_t)4 * (width - 1), 3);
    }
}
