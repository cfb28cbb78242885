/* Raw colour pictures of cameras to RGBA. */
#include "io/driver/pixels.h"

#include <string.h>

static ptrdiff_t row_size(io_pixel_format format, int32_t width)
{
    switch (format) {
    case IO_PIXEL_RGB8:
    case IO_PIXEL_BGR8: return (ptrdiff_t)width * 3;
    case IO_PIXEL_RGBX8:
    case IO_PIXEL_BGRX8: return (ptrdiff_t)width * 4;
    case IO_PIXEL_YUYV: return (ptrdiff_t)(width + (width & 1)) * 2;
    case IO_PIXEL_NONE: break;
    }
    return 0;
}

/* `step` bytes a pixel, red at `red` and blue at `blue`. */
static void convert_row(const uint8_t *in, int step, int red, uint8_t *out, int32_t width)
{
    const int blue = 2 - red;
    for (int32_t x = 0; x < width; x++, in += step, out += 4) {
        out[0] = in[red];
        out[1] = in[1];
        out[2] = in[blue];
        out[3] = 255;
    }
}

static uint8_t clamp_8(int32_t scaled)
{
    const int32_t value = (scaled + (1 << 15)) >> 16;
    return (uint8_t)(value < 0 ? 0 : value > 255 ? 255 : value);
}

/* Recommendation ITU-R BT.601: coefficients times 2^16 of 255/219 and of 255/224 times 1.402,
 * 0.344, 0.714 and 1.772. */
static void convert_row_yuyv(const uint8_t *in, uint8_t *out, int32_t width)
{
    for (int32_t x = 0; x < width; x++, out += 4) {
        const uint8_t *pair = in + (ptrdiff_t)(x / 2) * 4;
        const int32_t y = 76309 * (pair[(x & 1) * 2] - 16);
        const int32_t u = pair[1] - 128;
        const int32_t v = pair[3] - 128;
        out[0] = clamp_8(y + 104597 * v);
        out[1] = clamp_8(y - 25675 * u - 53279 * v);
        out[2] = clamp_8(y + 132201 * u);
        out[3] = 255;
    }
}

static void mirror_row(uint8_t *row, int32_t width)
{
    for (int32_t left = 0, right = width - 1; left < right; left++, right--) {
        uint8_t pixel[4];
        memcpy(pixel, row + (ptrdiff_t)left * 4, 4);
        memcpy(row + (ptrdiff_t)left * 4, row + (ptrdiff_t)right * 4, 4);
        memcpy(row + (ptrdiff_t)right * 4, pixel, 4);
    }
}

bool io_pixels_to_rgba(const io_raw_picture *raw, bool is_mirrored, const rlf_image_rgba8 *out)
{
    const ptrdiff_t row = row_size(raw->format, out->width);
    if (raw->data == NULL || row == 0 || raw->stride < row ||
        raw->size < (size_t)raw->stride * (size_t)(out->height - 1) + (size_t)row) {
        return false;
    }
    for (int32_t y = 0; y < out->height; y++) {
        const uint8_t *in = raw->data + (ptrdiff_t)y * raw->stride;
        uint8_t *to = rlf_rgba8_row(out, y);
        switch (raw->format) {
        case IO_PIXEL_RGB8: convert_row(in, 3, 0, to, out->width); break;
        case IO_PIXEL_BGR8: convert_row(in, 3, 2, to, out->width); break;
        case IO_PIXEL_RGBX8: convert_row(in, 4, 0, to, out->width); break;
        case IO_PIXEL_BGRX8: convert_row(in, 4, 2, to, out->width); break;
        case IO_PIXEL_YUYV: convert_row_yuyv(in, to, out->width); break;
        case IO_PIXEL_NONE: break;
        }
        if (is_mirrored) {
            mirror_row(to, out->width);
        }
    }
    return true;
}
