/* RGBA to planar YUV 4:2:0, Recommendation ITU-R BT.601 with limited range. */
#include "io/video/video.h"

/* Coefficients times 2^16: 219/255 (0.299, 0.587, 0.114) for Y; for U and V
 * 224/255 (B - Y') / 1.772 and (R - Y') / 1.402 of the full-range luma. The Y row sums to
 * 219/255 * 2^16, the others to 0, so greys come out exactly. */
enum {
    Y_R = 16829,
    Y_G = 33039,
    Y_B = 6416,
    U_R = -9714,
    U_G = -19070,
    U_B = 28784,
    V_R = 28784,
    V_G = -24103,
    V_B = -4681,
    SHIFT = 16,
    HALF = 1 << 15
};

rlf_result io_yuv_create(int32_t width, int32_t height, io_yuv *out)
{
    *out = (io_yuv){.width = width + (width & 1), .height = height + (height & 1)};
    size_t luma = (size_t)out->width * (size_t)out->height;
    out->y = rlf_alloc(luma + luma / 2);
    if (out->y == NULL) {
        return RLF_ERROR_MEMORY;
    }
    out->u = out->y + luma;
    out->v = out->u + luma / 4;
    return RLF_OK;
}

void io_yuv_destroy(io_yuv *yuv)
{
    rlf_free(yuv->y);
    *yuv = (io_yuv){0};
}

size_t io_yuv_size(const io_yuv *yuv)
{
    size_t luma = (size_t)yuv->width * (size_t)yuv->height;
    return luma + luma / 2;
}

static uint8_t luma_of(const uint8_t *p)
{
    return (uint8_t)(16 + ((Y_R * p[0] + Y_G * p[1] + Y_B * p[2] + HALF) >> SHIFT));
}

/* From the sum of four pixels; the offset of 128 makes it positive before the shift. */
static uint8_t chroma_of(const int32_t sum[3], int32_t r, int32_t g, int32_t b)
{
    int32_t scaled = r * sum[0] + g * sum[1] + b * sum[2];
    return (uint8_t)((scaled + 4 * ((128 << SHIFT) + HALF)) >> (SHIFT + 2));
}

static void convert_block(const uint8_t *const p[4], uint8_t *const y[2], uint8_t *u, uint8_t *v)
{
    y[0][0] = luma_of(p[0]);
    y[0][1] = luma_of(p[1]);
    y[1][0] = luma_of(p[2]);
    y[1][1] = luma_of(p[3]);
    int32_t sum[3];
    for (int c = 0; c < 3; c++) {
        sum[c] = p[0][c] + p[1][c] + p[2][c] + p[3][c];
    }
    *u = chroma_of(sum, U_R, U_G, U_B);
    *v = chroma_of(sum, V_R, V_G, V_B);
}

void io_yuv_from_rgba(const rlf_image_rgba8 *image, io_yuv *yuv)
{
    for (int32_t y = 0; y < yuv->height; y += 2) {
        const uint8_t *top = rlf_rgba8_row(image, y);
        const uint8_t *bottom = rlf_rgba8_row(image, y + 1 < image->height ? y + 1 : y);
        uint8_t *luma = yuv->y + (size_t)y * (size_t)yuv->width;
        size_t chroma = (size_t)(y / 2) * (size_t)(yuv->width / 2);
        for (int32_t x = 0; x < yuv->width; x += 2) {
            ptrdiff_t left = (ptrdiff_t)x * 4;
            ptrdiff_t right = x + 1 < image->width ? left + 4 : left;
            const uint8_t *const pixels[4] = {top + left, top + right, bottom + left,
                                              bottom + right};
            uint8_t *const rows[2] = {luma + x, luma + yuv->width + x};
            convert_block(pixels, rows, yuv->u + chroma + x / 2, yuv->v + chroma + x / 2);
        }
    }
}

static int32_t greatest_common_divisor(int32_t a, int32_t b)
{
    while (b != 0) {
        int32_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

io_rate io_rate_from(double frames_per_second)
{
    double ntsc = frames_per_second * 1.001;
    int32_t whole = (int32_t)(ntsc + 0.5);
    double off = ntsc - whole;
    bool is_whole = (double)(int32_t)frames_per_second == frames_per_second;
    /* 29.97 is as near to 30000/1001 as two decimals get. */
    if (!is_whole && off * off < 1e-6 && whole % 6 == 0) {
        return (io_rate){whole * 1000, 1001};
    }
    int32_t thousandths = (int32_t)(frames_per_second * 1000.0 + 0.5);
    int32_t divisor = greatest_common_divisor(thousandths, 1000);
    return (io_rate){thousandths / divisor, 1000 / divisor};
}
