/* Raw colour pictures of cameras to RGBA. */
#include "io/driver/pixels.h"

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

/* Where the pixels of a row go: the first one, and bytes from one to the next, which are fewer than
 * 0 in a mirrored picture. */
typedef struct target {
    uint8_t *first;
    ptrdiff_t step;
    int32_t width;
} target;

/* `step` bytes a pixel, the first of them red (`red` 0) or blue (`red` 2). */
static void convert_row(const uint8_t *in, int step, int red, target to)
{
    const int blue = 2 - red;
    uint8_t *out = to.first;
    for (int32_t x = 0; x < to.width; x++, in += step, out += to.step) {
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

/* What the chroma of a pair of pixels adds, times 2^16. */
typedef struct chroma {
    int32_t red, green, blue;
} chroma;

static void put(uint8_t *out, uint8_t luma, chroma c)
{
    const int32_t y = 76309 * (luma - 16);
    out[0] = clamp_8(y + c.red);
    out[1] = clamp_8(y + c.green);
    out[2] = clamp_8(y + c.blue);
    out[3] = 255;
}

/* Recommendation ITU-R BT.601: coefficients times 2^16 of 255/219, and of 255/224 times 1.402,
 * 0.344, 0.714 and 1.772. */
static void convert_row_yuyv(const uint8_t *in, target to)
{
    uint8_t *out = to.first;
    for (int32_t x = 0; x < to.width; x += 2, in += 4, out += 2 * to.step) {
        const int32_t u = in[1] - 128;
        const int32_t v = in[3] - 128;
        const chroma c = {104597 * v, -25675 * u - 53279 * v, 132201 * u};
        put(out, in[0], c);
        if (x + 1 < to.width) {
            put(out + to.step, in[2], c);
        }
    }
}

bool io_raw_picture_to_rgba(const io_raw_picture *raw, bool is_mirrored, const rlf_image_rgba8 *out)
{
    const ptrdiff_t row = row_size(raw->format, out->width);
    if (raw->data == NULL || row == 0 || raw->stride < row ||
        raw->size < (size_t)raw->stride * (size_t)(out->height - 1) + (size_t)row) {
        return false;
    }
    for (int32_t y = 0; y < out->height; y++) {
        const uint8_t *in = raw->data + (ptrdiff_t)y * raw->stride;
        uint8_t *left = rlf_rgba8_row(out, y);
        const target to = {is_mirrored ? left + (ptrdiff_t)(out->width - 1) * 4 : left,
                           is_mirrored ? -4 : 4, out->width};
        switch (raw->format) {
        case IO_PIXEL_RGB8: convert_row(in, 3, 0, to); break;
        case IO_PIXEL_BGR8: convert_row(in, 3, 2, to); break;
        case IO_PIXEL_RGBX8: convert_row(in, 4, 0, to); break;
        case IO_PIXEL_BGRX8: convert_row(in, 4, 2, to); break;
        case IO_PIXEL_YUYV: convert_row_yuyv(in, to); break;
        case IO_PIXEL_NONE: break;
        }
    }
    return true;
}
