/* Raw colour and grey pictures to RGBA. */
#include "io/picture/pixels.h"

#include <string.h>

/* ---- three bytes of a pixel to four and back: the copies that every picture of a network pays.
 * All but the last pixel go as four bytes; the one too many is set right at once ---- */

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

/* ---- pictures straight from a sensor with a colour filter over each pixel ---------------- */

/* 0 red, 1 green, 2 blue. */
static int32_t color_at(int32_t x, int32_t y, int32_t red_x, int32_t red_y)
{
    return ((x ^ red_x) & 1) + ((y ^ red_y) & 1);
}

/* Adds up the colours of the 3x3 pixels around; of the pixel's own colour only itself counts. */
static void add_around(const io_pixels *in, const int32_t at[2], const int32_t red[2],
                       int32_t sum[3], int32_t count[3])
{
    const int32_t own = color_at(at[0], at[1], red[0], red[1]);
    for (int32_t y = at[1] - 1; y <= at[1] + 1; y++) {
        for (int32_t x = at[0] - 1; x <= at[0] + 1; x++) {
            if (x < 0 || y < 0 || x >= (int32_t)in->width || y >= (int32_t)in->height) {
                continue;
            }
            const int32_t color = color_at(x, y, red[0], red[1]);
            if (color != own || (x == at[0] && y == at[1])) {
                sum[color] += in->data[y * in->step + x];
                count[color]++;
            }
        }
    }
}

/* Row y as RGBA: each missing colour is the mean of that colour's nearest pixels (bilinear). The
 * first red pixel is at (red_x, red_y), each 0 or 1. */
static void bayer_row(const io_pixels *in, int32_t red_x, int32_t red_y, int32_t y, uint8_t *out)
{
    const int32_t red[2] = {red_x, red_y};
    for (int32_t x = 0; x < (int32_t)in->width; x++) {
        const int32_t at[2] = {x, y};
        int32_t sum[3] = {0};
        int32_t count[3] = {0};
        add_around(in, at, red, sum, count);
        for (int i = 0; i < 3; i++) {
            out[4 * x + i] = count[i] > 0 ? (uint8_t)((sum[i] + count[i] / 2) / count[i]) : 0;
        }
        out[4 * x + 3] = 255;
    }
}

/* ---- all encodings ------------------------------------------------------------------------- */

typedef enum layout {
    LAYOUT_PACKED, /* the channels of a pixel side by side */
    LAYOUT_YUV_422,
    LAYOUT_YUV_420, /* a plane of luma, then rows of chroma for two rows each */
    LAYOUT_BAYER
} layout;

typedef struct encoding {
    const char *name;
    layout layout;
    int32_t pixel_size;
    /* Packed: where red, green and blue are. 4:2:2: where the first luma, u and v are. 4:2:0: where
     * u and v are. Bayer: column and row of the first red. */
    int32_t a, b, c;
} encoding;

static const encoding encodings[] = {
    {"rgb8", LAYOUT_PACKED, 3, 0, 1, 2},         {"rgba8", LAYOUT_PACKED, 4, 0, 1, 2},
    {"bgr8", LAYOUT_PACKED, 3, 2, 1, 0},         {"bgra8", LAYOUT_PACKED, 4, 2, 1, 0},
    {"8UC3", LAYOUT_PACKED, 3, 2, 1, 0},         {"8UC4", LAYOUT_PACKED, 4, 2, 1, 0},
    {"mono8", LAYOUT_PACKED, 1, 0, 0, 0},        {"8UC1", LAYOUT_PACKED, 1, 0, 0, 0},
    {"mono16", LAYOUT_PACKED, 2, 1, 1, 1},       {"16UC1", LAYOUT_PACKED, 2, 1, 1, 1},
    {"yuv422", LAYOUT_YUV_422, 2, 1, 0, 2},      {"uyvy", LAYOUT_YUV_422, 2, 1, 0, 2},
    {"yuv422_yuy2", LAYOUT_YUV_422, 2, 0, 1, 3}, {"yuyv", LAYOUT_YUV_422, 2, 0, 1, 3},
    {"nv12", LAYOUT_YUV_420, 1, 0, 1, 0},        {"nv21", LAYOUT_YUV_420, 1, 1, 0, 0},
    {"bayer_rggb8", LAYOUT_BAYER, 1, 0, 0, 0},   {"bayer_grbg8", LAYOUT_BAYER, 1, 1, 0, 0},
    {"bayer_gbrg8", LAYOUT_BAYER, 1, 0, 1, 0},   {"bayer_bggr8", LAYOUT_BAYER, 1, 1, 1, 0},
};

static const encoding *find_encoding(const char *name)
{
    for (size_t i = 0; i < sizeof(encodings) / sizeof(encodings[0]); i++) {
        if (strcmp(encodings[i].name, name) == 0) {
            return &encodings[i];
        }
    }
    return NULL;
}

bool io_pixels_is_picture(const char *encoding_name)
{
    return find_encoding(encoding_name) != NULL;
}

static void put(uint8_t *out, uint8_t red, uint8_t green, uint8_t blue)
{
    out[0] = red;
    out[1] = green;
    out[2] = blue;
    out[3] = 255;
}

static void packed_row(const encoding *e, const uint8_t *row, int32_t width, uint8_t *out)
{
    if (e->pixel_size == 3 && e->a == 0) {
        io_rgb_to_rgba(row, width, out);
        return;
    }
    for (int32_t x = 0; x < width; x++) {
        put(out + 4 * x, row[e->a], row[e->b], row[e->c]);
        row += e->pixel_size;
    }
}

static uint8_t clamp_byte(int32_t x)
{
    return (uint8_t)(x < 0 ? 0 : (x > 255 ? 255 : x));
}

/* YUV of full or limited range to RGB (BT.601), three bytes. */
static void yuv_to_rgb(int32_t y, int32_t u, int32_t v, bool is_full_range, uint8_t *out)
{
    /* Fractions of 2^16 of ITU-R BT.601; limited range stretches 16..235 to 0..255. */
    const int32_t luma = (is_full_range ? y * 65536 : (y - 16) * 76309) + 32768;
    const int32_t cb = u - 128;
    const int32_t cr = v - 128;
    const int32_t red = is_full_range ? 91881 * cr : 104597 * cr;
    const int32_t green = is_full_range ? 22554 * cb + 46802 * cr : 25675 * cb + 53279 * cr;
    const int32_t blue = is_full_range ? 116130 * cb : 132201 * cb;
    put(out, clamp_byte((luma + red) / 65536), clamp_byte((luma - green) / 65536),
        clamp_byte((luma + blue) / 65536));
}

static void yuv_422_row(const encoding *e, const uint8_t *row, int32_t width, uint8_t *out)
{
    for (int32_t x = 0; x < width; x++) {
        const uint8_t *pair = row + 2 * (x & ~1);
        /* The last pixel of an odd width has no v of its own: its grey is what is known. */
        const bool is_whole = (x | 1) < width;
        const int32_t y = row[2 * x + e->a];
        yuv_to_rgb(y, is_whole ? pair[e->b] : 128, is_whole ? pair[e->c] : 128, false, out + 4 * x);
    }
}

static void yuv_420_row(const encoding *e, const io_pixels *in, int32_t y, uint8_t *out)
{
    const uint8_t *luma = in->data + y * in->step;
    const uint8_t *chroma = in->data + (in->height + y / 2) * in->step;
    for (int32_t x = 0; x < (int32_t)in->width; x++) {
        const uint8_t *pair = chroma + (x & ~1);
        const bool is_whole = (x | 1) < in->width;
        yuv_to_rgb(luma[x], is_whole ? pair[e->a] : 128, is_whole ? pair[e->b] : 128, false,
                   out + 4 * x);
    }
}

static void convert_row(const encoding *e, const io_pixels *in, int32_t y, uint8_t *out)
{
    const uint8_t *row = in->data + y * in->step;
    const int32_t width = (int32_t)in->width;
    switch (e->layout) {
    case LAYOUT_PACKED: packed_row(e, row, width, out); break;
    case LAYOUT_YUV_422: yuv_422_row(e, row, width, out); break;
    case LAYOUT_YUV_420: yuv_420_row(e, in, y, out); break;
    case LAYOUT_BAYER: bayer_row(in, e->a, e->b, y, out); break;
    }
}

static rlf_result check_size(const io_pixels *in, const rlf_image_rgba8 *out)
{
    if (in->width == out->width && in->height == out->height) {
        return RLF_OK;
    }
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: the picture is %lld x %lld but the calibration is for %d x %d: give the "
                    "right one with ?camera=FILE",
                    in->name, (long long)in->width, (long long)in->height, (int)out->width,
                    (int)out->height);
}

rlf_result io_pixels_to_rgba(const io_pixels *in, const rlf_image_rgba8 *out)
{
    const encoding *found = find_encoding(in->encoding);
    if (found == NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the colour pictures are \"%.32s\": record them as rgb8, bgr8 or JPEG",
                        in->name, in->encoding);
    }
    encoding e = *found;
    if (e.layout == LAYOUT_PACKED && e.pixel_size == 2 && in->is_bigendian) {
        e.a = e.b = e.c = 0;
    }
    rlf_result result = check_size(in, out);
    io_pixels rows = *in;
    if (result == RLF_OK) {
        rows.step = in->step != 0 ? in->step : in->width * e.pixel_size;
        const int64_t planes = e.layout == LAYOUT_YUV_420 ? (in->height + 1) / 2 : 0;
        result = io_pixels_check(&rows, e.pixel_size, in->height + planes);
    }
    for (int32_t y = 0; result == RLF_OK && y < out->height; y++) {
        convert_row(&e, &rows, y, rlf_rgba8_row(out, y));
    }
    return result;
}
