/* Pictures in ROS messages. */
#include "io/ros/recording.h"

#include "io/picture/picture.h"
#include "io/picture/pixels.h"
#include "io/little.h"

/* compressed_depth_image_transport: what kind, and two floats that turn counts into inverse depth.
 */
#define DEPTH_HEAD 12

static io_ros_pixels raw_pixels(const char *encoding)
{
    if (io_pixels_is_depth(encoding)) {
        return strcmp(encoding, "32FC1") == 0 ? IO_ROS_DEPTH_F32 : IO_ROS_DEPTH_U16;
    }
    if (strcmp(encoding, "mono8") == 0 || strcmp(encoding, "8UC1") == 0) {
        return IO_ROS_MONO8;
    }
    return io_pixels_is_picture(encoding) ? IO_ROS_COLOR : IO_ROS_UNKNOWN;
}

/* "16UC1; compressedDepth rvl", "16UC1; compressedDepth", "rgb8; jpeg compressed bgr8", "png". */
static io_ros_pixels compressed_pixels(const io_ros_image *image)
{
    const char *format = image->encoding;
    const bool is_metres = strncmp(format, "32FC1", 5) == 0;
    if (strstr(format, "compressedDepth") != NULL) {
        if (strstr(format, "rvl") != NULL) {
            return is_metres ? IO_ROS_DEPTH_RVL_F32 : IO_ROS_DEPTH_RVL;
        }
        return is_metres ? IO_ROS_DEPTH_PNG_F32 : IO_ROS_DEPTH_PNG;
    }
    /* The plain compressed transport and cv_bridge: the file itself tells. */
    const io_cdr_span *d = &image->data;
    const bool is_jpeg = d->size >= 2 && d->data[0] == 0xFF && d->data[1] == 0xD8;
    const io_bytes file = {"", d->data, d->size};
    if (io_compressed_depth_is(&file, format)) {
        return IO_ROS_DEPTH_PNG;
    }
    return is_jpeg || io_png_is(&file) ? IO_ROS_PICTURE : IO_ROS_UNKNOWN;
}

io_ros_pixels io_ros_pixels_of(const io_ros_image *image, bool is_compressed)
{
    return is_compressed ? compressed_pixels(image) : raw_pixels(image->encoding);
}

bool io_ros_is_depth(io_ros_pixels pixels)
{
    return pixels >= IO_ROS_DEPTH_U16 && pixels <= IO_ROS_DEPTH_PNG_F32;
}

bool io_ros_is_metres(io_ros_pixels pixels)
{
    return pixels == IO_ROS_DEPTH_F32 || pixels == IO_ROS_DEPTH_RVL_F32 ||
           pixels == IO_ROS_DEPTH_PNG_F32;
}

bool io_ros_picture_size(const io_ros_image *image, io_ros_pixels pixels, int32_t *out_width,
                         int32_t *out_height)
{
    const io_bytes file = {"", image->data.data, image->data.size};
    if (image->width == 0 && io_ros_is_depth(pixels)) {
        return io_compressed_depth_size(&file, image->encoding, out_width, out_height);
    }
    if (image->width == 0) {
        return pixels == IO_ROS_PICTURE && io_picture_size(&file, out_width, out_height);
    }
    *out_width = (int32_t)(image->width <= RLF_IMAGE_SIZE_MAX ? image->width : 0);
    *out_height = (int32_t)(image->height <= RLF_IMAGE_SIZE_MAX ? image->height : 0);
    return *out_width > 0 && *out_height > 0;
}

static rlf_result fail_size(const char *name, const io_ros_image *image, int32_t width,
                            int32_t height)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: a picture of %s at %.3f s has another size than the %d x %d of its "
                    "calibration, or is cut short: give one of its size with ?camera=FILE",
                    name, image->header.frame_id, 1e-9 * (double)image->header.stamp_ns, (int)width,
                    (int)height);
}

/* Rows of `bytes` per pixel, or NULL when they are not all there. */
static const uint8_t *raw_rows(const io_ros_image *image, int32_t width, int32_t height,
                               size_t bytes, size_t *out_step)
{
    const size_t row = (size_t)width * bytes;
    const size_t step = image->step > 0 ? image->step : row;
    *out_step = step;
    const bool is_whole = image->width == (uint32_t)width && image->height == (uint32_t)height &&
                          step >= row && image->data.size >= step * (size_t)(height - 1) + row;
    return is_whole ? image->data.data : NULL;
}

/* Rows without a gap, numbers of this machine. */
static rlf_result decode_metres(const char *name, const io_ros_image *image, int32_t width,
                                int32_t height, float *out)
{
    size_t step;
    const uint8_t *rows = raw_rows(image, width, height, sizeof(*out), &step);
    if (rows == NULL) {
        return fail_size(name, image, width, height);
    }
    for (int32_t y = 0; y < height; y++) {
        for (int32_t x = 0; x < width; x++) {
            const uint8_t *from = rows + (size_t)y * step + (size_t)x * sizeof(*out);
            uint8_t *to = (uint8_t *)(out + (ptrdiff_t)y * width + x);
            for (size_t b = 0; b < sizeof(*out); b++) {
                to[b] = from[image->is_bigendian != IO_IS_BIG_ENDIAN ? sizeof(*out) - 1 - b : b];
            }
        }
    }
    return RLF_OK;
}

/* depth = a / (count - b) */
static rlf_result decode_inverse(const io_ros_decoder *decoder, const io_ros_image *image,
                                 int32_t width, int32_t height, float *out)
{
    float parameters[2];
    if (image->data.size < DEPTH_HEAD || decoder->counts == NULL) {
        return fail_size(decoder->name, image, width, height);
    }
    memcpy(parameters, image->data.data + 4, sizeof(parameters));
    io_little(parameters, 2, sizeof(parameters[0]));
    const io_bytes file = {decoder->name, image->data.data, image->data.size};
    rlf_result result = io_compressed_depth_counts(&decoder->rvl, &file, image->encoding, width,
                                                   height, decoder->counts);
    for (size_t i = 0; result == RLF_OK && i < (size_t)width * (size_t)height; i++) {
        const uint16_t count = decoder->counts[i];
        out[i] = count > 0 ? parameters[0] / ((float)count - parameters[1]) : 0.0f;
    }
    return result;
}

static io_pixels raw_of(const io_ros_decoder *decoder, const io_ros_image *image)
{
    return (io_pixels){.name = decoder->name,
                       .encoding = image->encoding,
                       .width = image->width,
                       .height = image->height,
                       .step = image->step,
                       .is_bigendian = image->is_bigendian,
                       .data = image->data.data,
                       .size = image->data.size};
}

static rlf_result decode_rounded(const io_ros_decoder *decoder, const io_ros_image *image,
                                 bool is_raw, int32_t width, int32_t height, uint16_t *out)
{
    const io_pixels raw = raw_of(decoder, image);
    const io_bytes file = {decoder->name, image->data.data, image->data.size};
    double units;
    if (!is_raw) {
        return io_compressed_depth_decode(&decoder->rvl, &file, image->encoding, width, height, out,
                                          &units);
    }
    return raw.width == width && raw.height == height
               ? io_pixels_to_depth(&raw, out, &units)
               : fail_size(decoder->name, image, width, height);
}

rlf_result io_ros_decode_depth(const io_ros_decoder *decoder, const io_ros_image *image,
                               io_ros_pixels pixels, int32_t width, int32_t height, void *out)
{
    const bool is_raw = pixels == IO_ROS_DEPTH_U16 || pixels == IO_ROS_DEPTH_F32;
    if (!io_ros_is_metres(pixels) || decoder->rounds_metres) {
        return decode_rounded(decoder, image, is_raw, width, height, out);
    }
    return is_raw ? decode_metres(decoder->name, image, width, height, out)
                  : decode_inverse(decoder, image, width, height, out);
}

rlf_result io_ros_decode_color(const io_ros_decoder *decoder, const io_ros_image *image,
                               io_ros_pixels pixels, const rlf_image_rgba8 *out)
{
    if (pixels == IO_ROS_PICTURE || pixels == IO_ROS_DEPTH_PNG) {
        const io_bytes file = {decoder->name, image->data.data, image->data.size};
        io_picture picture = {
            .width = out->width, .height = out->height, .data = out->data, .is_opaque = true};
        return io_picture_decode(&file, &picture);
    }
    const io_pixels raw = raw_of(decoder, image);
    return io_pixels_to_rgba(&raw, out);
}
