/* Depth pictures of ROS's compressed_depth_image_transport. */
#include "io/picture/pixels.h"

#include "io/picture/picture.h"
#include "io/little.h"

#include <string.h>

#define HEADER_SIZE 12 /* int32 kind of quantisation, float a, float b */
#define RVL_SIZE 8     /* behind it: int32 width and height */

static float float_at(const uint8_t *at)
{
    float value;
    io_little_read(at, &value, sizeof(value));
    return value;
}

/* The codec stores 1/z = (n - b) / a, so that near depths get the finer steps. */
static void dequantise(const uint8_t *header, size_t count, uint16_t *depth)
{
    const double a = (double)float_at(header + 4);
    const double b = (double)float_at(header + 8);
    for (size_t i = 0; i < count; i++) {
        const double z = depth[i] > 0 ? a / ((double)depth[i] - b) : 0.0;
        const double counts = z * IO_PIXELS_FLOAT_UNITS + 0.5;
        depth[i] = counts >= 1.0 && counts < 65536.0 ? (uint16_t)counts : 0;
    }
}

static rlf_result fail_short(const io_bytes *file)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: the depth picture is damaged or cut short (%zu bytes): copy or record it "
                    "again",
                    file->name, file->size);
}

bool io_compressed_depth_is(const io_bytes *file, const char *format)
{
    return strstr(format, "compressedDepth") != NULL || io_png_is_u16(file);
}

static bool is_rvl(const char *format)
{
    return strstr(format, "rvl") != NULL;
}

/* The PNG behind the head; the plain compressed transport writes PNG alone. */
static io_bytes png_of(const io_bytes *file)
{
    if (io_png_is(file)) {
        return *file;
    }
    return file->size > HEADER_SIZE
               ? (io_bytes){file->name, file->data + HEADER_SIZE, file->size - HEADER_SIZE}
               : (io_bytes){file->name, NULL, 0};
}

bool io_compressed_depth_size(const io_bytes *file, const char *format, int32_t *out_width,
                              int32_t *out_height)
{
    int32_t size[2] = {0, 0};
    const io_bytes png = png_of(file);
    if (!is_rvl(format)) {
        return png.size > 0 && io_picture_size(&png, out_width, out_height);
    }
    if (file->size >= HEADER_SIZE + RVL_SIZE) {
        memcpy(size, file->data + HEADER_SIZE, sizeof(size));
        io_little(size, 2, sizeof(size[0]));
    }
    *out_width = size[0];
    *out_height = size[1];
    return size[0] > 0 && size[1] > 0 && size[0] <= RLF_IMAGE_SIZE_MAX &&
           size[1] <= RLF_IMAGE_SIZE_MAX;
}

static rlf_result decode_rvl(const io_rvl *rvl, const io_bytes *file, int32_t width, int32_t height,
                             uint16_t *out)
{
    int32_t size[2];
    const size_t head = HEADER_SIZE + RVL_SIZE;
    if (file->size < head) {
        return fail_short(file);
    }
    memcpy(size, file->data + HEADER_SIZE, sizeof(size));
    io_little(size, 2, sizeof(size[0]));
    if (size[0] != width || size[1] != height) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the depth picture is %d x %d but the calibration is for %d x %d: give "
                        "the right one with ?camera=FILE",
                        file->name, (int)size[0], (int)size[1], (int)width, (int)height);
    }
    const size_t count = (size_t)width * (size_t)height;
    return io_rvl_decode(rvl, file->data + head, file->size - head, out, count) ? RLF_OK
                                                                                : fail_short(file);
}

rlf_result io_compressed_depth_counts(const io_rvl *rvl, const io_bytes *file, const char *format,
                                      int32_t width, int32_t height, uint16_t *out)
{
    if (is_rvl(format)) {
        return decode_rvl(rvl, file, width, height, out);
    }
    const io_bytes png = png_of(file);
    if (png.size == 0) {
        return fail_short(file);
    }
    io_picture picture = {.width = width, .height = height, .data = out};
    return io_png_decode_u16(&png, &picture);
}

rlf_result io_compressed_depth_decode(const io_rvl *rvl, const io_bytes *file, const char *format,
                                      int32_t width, int32_t height, uint16_t *out,
                                      double *out_units_per_metre)
{
    const bool is_float = strncmp(format, "32FC1", 5) == 0;
    if (file->size <= HEADER_SIZE) {
        return fail_short(file);
    }
    rlf_result result = io_compressed_depth_counts(rvl, file, format, width, height, out);
    if (result == RLF_OK && is_float) {
        dequantise(file->data, (size_t)width * (size_t)height, out);
    }
    *out_units_per_metre = is_float ? IO_PIXELS_FLOAT_UNITS : 1000.0;
    return result;
}
