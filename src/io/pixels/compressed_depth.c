/* Depth pictures of ROS's compressed_depth_image_transport. */
#include "io/pixels/compressed_depth.h"

#include "io/pixels/pixels.h"

#include <string.h>

#define HEADER_SIZE 12 /* int32 kind of quantisation, float a, float b */

static float float_at(const uint8_t *at)
{
    float value;
    memcpy(&value, at, sizeof(value));
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

rlf_result io_compressed_depth_decode(const io_bytes *file, const char *format, int32_t width,
                                      int32_t height, uint16_t *out, double *out_units_per_metre)
{
    const bool is_float = strncmp(format, "32FC1", 5) == 0;
    if (file->size <= HEADER_SIZE) {
        return rlf_fail(RLF_ERROR_FORMAT,
                        "%s: the picture is cut short (%zu bytes): copy or record it again",
                        file->name, file->size);
    }
    if (strstr(format, "rvl") != NULL) {
        return rlf_fail(RLF_ERROR_UNSUPPORTED,
                        "%s: the depth pictures are \"%.48s\": record them as PNG", file->name,
                        format);
    }
    const io_bytes png = {file->name, file->data + HEADER_SIZE, file->size - HEADER_SIZE};
    io_picture picture = {.width = width, .height = height, .data = out};
    rlf_result result = io_png_decode_u16(&png, &picture);
    if (result == RLF_OK && is_float) {
        dequantise(file->data, (size_t)width * (size_t)height, out);
    }
    *out_units_per_metre = is_float ? IO_PIXELS_FLOAT_UNITS : 1000.0;
    return result;
}
