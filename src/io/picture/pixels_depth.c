/* Raw depth pictures to counts. */
#include "io/picture/pixels.h"

#include <string.h>

rlf_result io_pixels_check(const io_pixels *in, int32_t pixel_size, int64_t row_count)
{
    const int64_t most = RLF_IMAGE_SIZE_MAX;
    if (in->width < 1 || in->height < 1 || in->width > most || in->height > most) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: the picture is %lld x %lld: use sizes of 1 to %lld",
                        in->name, (long long)in->width, (long long)in->height, (long long)most);
    }
    const int64_t row_size = in->width * pixel_size;
    /* A step is bounded before it is multiplied. */
    if (in->step < row_size || in->step > UINT32_MAX ||
        (int64_t)(in->size / (size_t)in->step) < row_count - 1 ||
        (int64_t)in->size - in->step * (row_count - 1) < row_size) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the picture is cut short: %zu bytes cannot hold %lld rows of %lld: "
                        "copy or record it again",
                        in->name, in->size, (long long)row_count, (long long)in->step);
    }
    return RLF_OK;
}

static bool is_counts(const char *encoding)
{
    return strcmp(encoding, "16UC1") == 0 || strcmp(encoding, "mono16") == 0;
}

static bool is_metres(const char *encoding)
{
    return strcmp(encoding, "32FC1") == 0;
}

bool io_pixels_is_depth(const char *encoding)
{
    return is_counts(encoding) || is_metres(encoding);
}

static void copy_counts(const io_pixels *in, uint16_t *out)
{
    const int high = in->is_bigendian ? 0 : 1;
    for (int64_t y = 0; y < in->height; y++) {
        const uint8_t *row = in->data + y * in->step;
        for (int64_t x = 0; x < in->width; x++) {
            *out++ = (uint16_t)(row[2 * x + high] << 8 | row[2 * x + 1 - high]);
        }
    }
}

static float float_at(const uint8_t *at, bool is_bigendian)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; i++) {
        bits = bits << 8 | at[is_bigendian ? i : 3 - i];
    }
    float value;
    memcpy(&value, &bits, sizeof(value));
    return value;
}

static void round_metres(const io_pixels *in, uint16_t *out)
{
    for (int64_t y = 0; y < in->height; y++) {
        const uint8_t *row = in->data + y * in->step;
        for (int64_t x = 0; x < in->width; x++) {
            const double counts =
                (double)float_at(row + 4 * x, in->is_bigendian) * IO_PIXELS_FLOAT_UNITS + 0.5;
            /* False for NaN too. */
            const bool is_seen = counts >= 1.0 && counts < 65536.0;
            *out++ = is_seen ? (uint16_t)counts : 0;
        }
    }
}

rlf_result io_pixels_to_depth(const io_pixels *in, uint16_t *out, double *out_units_per_metre)
{
    const bool is_float = is_metres(in->encoding);
    if (!is_float && !is_counts(in->encoding)) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the depth pictures are \"%.32s\": record them as 16UC1 or 32FC1",
                        in->name, in->encoding);
    }
    const int64_t most = RLF_IMAGE_SIZE_MAX;
    io_pixels rows = *in;
    if (in->step == 0 && in->width > 0 && in->width <= most) {
        rows.step = in->width * (is_float ? 4 : 2);
    }
    rlf_result result = io_pixels_check(&rows, is_float ? 4 : 2, in->height);
    if (result != RLF_OK) {
        return result;
    }
    if (is_float) {
        round_metres(&rows, out);
    } else {
        copy_counts(&rows, out);
    }
    *out_units_per_metre = is_float ? IO_PIXELS_FLOAT_UNITS : 1000.0;
    return RLF_OK;
}
