/* Frames of a RealSense camera. */
#include "io/clip/clip.h"
#include "io/picture/pixels.h"
#include "io/realsense/realsense.h"

#include <math.h>
#include <string.h>

/* Waits in silence after which the camera is looked for: it may have been pulled out, and the
 * library then only stops giving frames. */
#define WAITS_TO_LOOK 4

/* The pictures of one moment. */
typedef struct pictures {
    rs2_frame *depth, *color; /* NULL = none */
} pictures;

static int stream_of(const realsense *r, const rs2_frame *frame)
{
    rs2_error *error = NULL;
    int stream = 0;
    int ignored[4] = {0};
    const rs2_stream_profile *p = r->api->get_frame_stream_profile(frame, &error);
    if (error == NULL) {
        r->api->get_stream_profile_data(p, &stream, &ignored[0], &ignored[1], &ignored[2],
                                        &ignored[3], &error);
    }
    return io_realsense_forget(r->api, &error) ? 0 : stream;
}

static pictures take_apart(const realsense *r, rs2_frame *set)
{
    pictures out = {0};
    rs2_error *error = NULL;
    const int count = r->api->embedded_frames_count(set, &error);
    for (int i = 0; i < count && error == NULL; i++) {
        rs2_frame *frame = r->api->extract_frame(set, i, &error);
        const int stream = error == NULL ? stream_of(r, frame) : 0;
        if (stream == RS2_STREAM_DEPTH && out.depth == NULL) {
            out.depth = frame;
        } else if (stream == RS2_STREAM_COLOR && out.color == NULL) {
            out.color = frame;
        } else if (error == NULL) {
            r->api->release_frame(frame);
        }
    }
    io_realsense_forget(r->api, &error);
    return out;
}

/* The frame's bytes; false when it has another size than its camera. */
static bool get_pixels(const realsense *r, const rs2_frame *frame, const rlf_camera *camera,
                       io_pixels *out)
{
    rs2_error *error = NULL;
    const bool has_size =
        r->api->get_frame_width(frame, &error) == camera->width && error == NULL &&
        r->api->get_frame_height(frame, &error) == camera->height && error == NULL;
    const int stride = has_size ? r->api->get_frame_stride_in_bytes(frame, &error) : 0;
    const int size = has_size && error == NULL ? r->api->get_frame_data_size(frame, &error) : 0;
    const void *data = has_size && error == NULL ? r->api->get_frame_data(frame, &error) : NULL;
    *out = (io_pixels){.name = r->source,
                       .width = camera->width,
                       .height = camera->height,
                       .step = stride,
                       .data = data,
                       .size = size > 0 ? (size_t)size : 0};
    return !io_realsense_forget(r->api, &error) && data != NULL && stride > 0;
}

/* Milliseconds as a double to nanoseconds; 0 when the library does not know. */
static int64_t time_of(const realsense *r, const rs2_frame *frame)
{
    rs2_error *error = NULL;
    const double ms = r->api->get_frame_timestamp(frame, &error);
    const bool is_known = !io_realsense_forget(r->api, &error) && ms > 0.0 && ms < 4.6e12;
    return is_known ? (int64_t)llround(ms * 1e6) : 0;
}

static int32_t domain_of(const realsense *r, const rs2_frame *frame)
{
    rs2_error *error = NULL;
    const int domain = r->api->get_frame_timestamp_domain(frame, &error);
    return io_realsense_forget(r->api, &error) ? -1 : domain;
}

static rlf_result fill_depth(realsense *r, const rs2_frame *depth, rlf_frame *out)
{
    io_pixels raw;
    if (!get_pixels(r, depth, &r->rig.depth, &raw) ||
        io_pixels_check(&raw, 2, raw.height) != RLF_OK) {
        r->count.damaged++;
        return RLF_NO_FRAME;
    }
    rs2_error *error = NULL;
    const uint64_t number = r->api->get_frame_number(depth, &error);
    if (error != NULL) {
        return io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
    }
    /* The first frames may carry the host's clock until the library has learnt the camera's. */
    const int32_t domain = domain_of(r, depth);
    r->count.is_restarted = r->count.is_restarted || domain != r->domain;
    r->domain = domain;
    out->depth_u16 = (const uint16_t *)(const void *)raw.data;
    out->depth_stride = (ptrdiff_t)raw.step;
    out->depth_units_per_metre = r->units_per_metre;
    return io_live_count_frame(&r->count, number, time_of(r, depth), out) ? RLF_OK : RLF_NO_FRAME;
}

static void fill_color(realsense *r, const rs2_frame *color, rlf_frame *out)
{
    io_pixels raw;
    if (color == NULL) {
        r->count.unpaired++;
        return;
    }
    const bool is_whole = get_pixels(r, color, &r->rig.color, &raw);
    raw.encoding = r->color_encoding;
    if (!is_whole || io_pixels_to_rgba(&raw, &r->color) != RLF_OK) {
        r->count.damaged++;
        return;
    }
    out->color = r->color;
    /* Two clocks cannot be compared: the library paired them. */
    if (domain_of(r, color) == r->domain) {
        out->color_time_ns = io_time_sum(time_of(r, color), r->count.offset_ns);
    }
}

static rlf_result fill(realsense *r, const pictures *p, rlf_frame *out)
{
    memset(out, 0, sizeof(*out));
    rlf_result result = p->depth != NULL ? fill_depth(r, p->depth, out) : RLF_NO_FRAME;
    if (result == RLF_OK && r->rig.has_color) {
        fill_color(r, p->color, out);
    }
    return result;
}

/* Nothing came: is the camera still there? */
static rlf_result look_for_camera(realsense *r)
{
    r->silent_waits++;
    if (r->silent_waits % WAITS_TO_LOOK != 0) {
        return RLF_NO_FRAME;
    }
    rs2_error *error = NULL;
    rs2_device_list *list = r->api->query_devices(r->context, &error);
    const int is_there = error == NULL ? r->api->device_list_contains(list, r->device, &error) : 0;
    if (list != NULL) {
        r->api->delete_device_list(list);
    }
    if (io_realsense_forget(r->api, &error) || is_there == 0) {
        return rlf_fail(RLF_ERROR_DEVICE, "%s: %s %s is gone: plug it in again", r->source, r->name,
                        r->serial);
    }
    return RLF_NO_FRAME;
}

rlf_result io_realsense_next(void *self, rlf_frame *out)
{
    realsense *r = self;
    rs2_error *error = NULL;
    rs2_frame *set = NULL;
    const int has_set =
        r->api->pipeline_try_wait_for_frames(r->pipeline, &set, IO_LIVE_WAIT_MS, &error);
    if (error != NULL) {
        return io_realsense_check(r->api, &error, RLF_ERROR_DEVICE, r->source, "plug it in again");
    }
    if (has_set == 0 || set == NULL) {
        return look_for_camera(r);
    }
    r->silent_waits = 0;
    const int64_t host_time_ns = rlf_clock_ns();
    pictures p = take_apart(r, set);
    r->api->release_frame(set);
    rlf_result result = fill(r, &p, out);
    out->host_time_ns = host_time_ns;
    rs2_frame *unused = p.depth;
    if (result == RLF_OK) {
        unused = r->held;
        r->held = p.depth;
    }
    if (unused != NULL) {
        r->api->release_frame(unused);
    }
    if (p.color != NULL) {
        r->api->release_frame(p.color);
    }
    return result;
}
