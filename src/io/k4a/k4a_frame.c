/* Frames of an Azure Kinect or Femto camera. */
#include "io/k4a/k4a.h"

#include "io/clip/clip.h"
#include "io/file.h"
#include "io/picture/picture.h"
#include "io/picture/pixels.h"

#include <string.h>

static bool has_size(const k4a *k, k4a_image_t image, const rlf_camera *camera)
{
    return k->api->image_get_width_pixels(image) == camera->width &&
           k->api->image_get_height_pixels(image) == camera->height &&
           k->api->image_get_buffer(image) != NULL;
}

static int64_t time_of(const k4a *k, k4a_image_t image)
{
    return io_live_time(k->api->image_get_device_timestamp_usec(image));
}

static rlf_result fill_depth(k4a *k, k4a_image_t image, rlf_frame *out)
{
    const rlf_camera *camera = &k->rig.depth;
    const io_pixels raw = {.name = k->source,
                           .width = camera->width,
                           .height = camera->height,
                           .step = k->api->image_get_stride_bytes(image),
                           .data = k->api->image_get_buffer(image),
                           .size = k->api->image_get_size(image)};
    if (!has_size(k, image, camera) || raw.step < 1 ||
        io_pixels_check(&raw, 2, raw.height) != RLF_OK) {
        k->count.damaged++;
        return RLF_NO_FRAME;
    }
    out->depth_u16 = (const uint16_t *)(const void *)raw.data;
    out->depth_stride = (ptrdiff_t)raw.step;
    out->depth_units_per_metre = 1000.0;
    return io_live_count_time(&k->count, time_of(k, image), out) ? RLF_OK : RLF_NO_FRAME;
}

static bool decode(k4a *k, k4a_image_t image)
{
    const size_t size = k->api->image_get_size(image);
    const uint8_t *data = k->api->image_get_buffer(image);
    const int format = k->api->image_get_format(image);
    if (format == K4A_FORMAT_COLOR_MJPG) {
        const io_bytes file = {.name = k->source, .data = data, .size = size};
        io_picture picture = {.width = k->color.width,
                              .height = k->color.height,
                              .data = k->color.data,
                              .is_opaque = true};
        return io_jpeg_decode_rgba(&file, &picture) == RLF_OK;
    }
    const io_pixels raw = {.name = k->source,
                           .encoding = format == K4A_FORMAT_COLOR_BGRA32 ? "bgra8"
                                       : format == K4A_FORMAT_COLOR_YUY2 ? "yuyv"
                                                                         : "unknown",
                           .width = k->color.width,
                           .height = k->color.height,
                           .step = k->api->image_get_stride_bytes(image),
                           .data = data,
                           .size = size};
    return io_pixels_to_rgba(&raw, &k->color) == RLF_OK;
}

static void fill_color(k4a *k, k4a_image_t image, rlf_frame *out)
{
    if (image == NULL) {
        k->count.unpaired++;
        return;
    }
    if (!has_size(k, image, &k->rig.color) || !decode(k, image)) {
        k->count.damaged++;
        return;
    }
    out->color = k->color;
    out->color_time_ns = io_time_sum(time_of(k, image), k->count.offset_ns);
}

static rlf_result fill(k4a *k, k4a_capture_t capture, rlf_frame *out)
{
    memset(out, 0, sizeof(*out));
    k4a_image_t depth = k->api->capture_get_depth_image(capture);
    if (depth == NULL) {
        return RLF_NO_FRAME; /* colour alone */
    }
    rlf_result result = fill_depth(k, depth, out);
    if (result == RLF_OK && k->rig.has_color) {
        k4a_image_t color = k->api->capture_get_color_image(capture);
        fill_color(k, color, out);
        if (color != NULL) {
            k->api->image_release(color);
        }
    }
    k4a_image_t unused = depth;
    if (result == RLF_OK) {
        unused = k->held;
        k->held = depth;
    }
    if (unused != NULL) {
        k->api->image_release(unused);
    }
    return result;
}

rlf_result io_k4a_next(void *self, rlf_frame *out)
{
    k4a *k = self;
    k4a_capture_t capture = NULL;
    const int state = k->api->device_get_capture(k->device, &capture, IO_LIVE_WAIT_MS);
    const int64_t host_time_ns = rlf_clock_ns();
    if (state == K4A_WAIT_TIMEOUT) {
        return RLF_NO_FRAME;
    }
    if (state != K4A_SUCCEEDED || capture == NULL) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: the camera %s is gone: plug it in again", k->source,
                        k->serial);
    }
    rlf_result result = fill(k, capture, out);
    k->api->capture_release(capture);
    out->host_time_ns = host_time_ns;
    return result;
}
