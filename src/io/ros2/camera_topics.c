/* Frames as a camera's topics. */
#include "io/ros2/publish.h"

#include "io/ros2/find_camera.h"
#include "io/source/address.h"

#include <stdio.h>
#include <string.h>

#define MM_PER_M 1000.0
/* A frame that is due so much earlier or later is another take. */
#define CLOCK_STEP_NS INT64_C(500000000)

rlf_result io_ros2_target_read(const char *address, io_ros2_target *out)
{
    io_address parts;
    rlf_result result = io_address_parse(address, &parts);
    if (result != RLF_OK) {
        return result;
    }
    const char *domain = io_address_take(&parts, "domain");
    const char *profile = io_address_take(&parts, "profile");
    const char *name = parts.place;
    if (parts.key_count > 0 || name[0] != '/' || name[1] == '\0' ||
        strlen(name) >= sizeof(out->name)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "%s: give a name and no other key than domain and profile, as in "
                        "ros2:/camera?profile=lan",
                        address);
    }
    memcpy(out->name, name, strlen(name) + 1);
    return io_ros2_place_read(address, domain, profile, &out->place);
}

/* "NAME/PART"; false when it is too long. */
static bool name_topic(const char *name, const char *part, char out[IO_ROS2_TOPIC_MAX])
{
    size_t length = strlen(name);
    while (length > 0 && name[length - 1] == '/') {
        length--;
    }
    const int got = snprintf(out, IO_ROS2_TOPIC_MAX, "%s%.*s/%s", name[0] == '/' ? "" : "/",
                             (int)length, name, part);
    /* DDS's name has "rt" in front. */
    return got > 0 && got < IO_ROS2_TOPIC_MAX - 2;
}

void io_ros2_frame_name(const char *name, const char *part, char out[IO_ROS_NAME_MAX])
{
    const char *begin = name + strspn(name, "/");
    snprintf(out, IO_ROS_NAME_MAX, "%.80s%s%s", begin, begin[0] != '\0' ? "_" : "", part);
    for (char *c = out; *c != '\0'; c++) {
        *c = *c == '/' ? '_' : *c;
    }
}

int64_t io_ros2_clock_offset(io_ros2_clock *clock, int64_t time_ns, int64_t now_ns)
{
    const int64_t off_ns = now_ns - (time_ns + clock->offset_ns);
    if (!clock->has_offset || off_ns > CLOCK_STEP_NS || off_ns < -CLOCK_STEP_NS) {
        clock->has_offset = true;
        clock->offset_ns = now_ns - time_ns;
    }
    return clock->offset_ns;
}

/* ---- topics --------------------------------------------------------------------------------- */

rlf_result io_ros2_open_outputs(io_ros2_node *node, const char *name, const io_ros2_output *rows,
                                size_t count)
{
    rlf_result result = RLF_OK;
    for (size_t i = 0; i < count && result == RLF_OK; i++) {
        char topic[IO_ROS2_TOPIC_MAX];
        result =
            name_topic(name, rows[i].part, topic)
                ? io_ros2_writer_open(node, topic, rows[i].type, false, rows[i].out)
                : rlf_fail(RLF_ERROR_INVALID, "ros2:%.60s: the name is too long for a topic", name);
    }
    return result;
}

rlf_result io_ros2_camera_open(io_ros2_node *node, const char *name, const rlf_rig *rig,
                               const rlf_recording_def *def, io_ros2_camera *c)
{
    const char *image = io_ros_type_name(IO_ROS_IMAGE);
    const char *packed = io_ros_type_name(IO_ROS_COMPRESSED_IMAGE);
    const char *info = io_ros_type_name(IO_ROS_CAMERA_INFO);
    const io_ros2_output rows[] = {{"depth/image_raw", image, &c->depth},
                                   {"depth/image_raw/compressedDepth", packed, &c->depth_packed},
                                   {"depth/camera_info", info, &c->depth_info},
                                   {"color/image_raw", image, &c->color},
                                   {"color/image_raw/compressed", packed, &c->color_packed},
                                   {"color/camera_info", info, &c->color_info}};
    const size_t count = rig->has_color ? 6 : 3;
    rlf_result result = io_ros_encoder_init(&c->encoder, rig, def);
    c->units = rlf_alloc_array((size_t)rig->depth.width * (size_t)rig->depth.height, 4);
    result = result == RLF_OK && c->units == NULL ? RLF_ERROR_MEMORY : result;
    io_ros2_frame_name(name, "depth_optical_frame", c->depth_frame);
    io_ros2_frame_name(name, "color_optical_frame", c->color_frame);
    result = result == RLF_OK ? io_ros2_open_outputs(node, name, rows, count) : result;
    if (result == RLF_OK && rig->has_color) {
        result = io_ros2_writer_open(node, "/tf_static", io_ros_type_name(IO_ROS_TF), true,
                                     &c->tf_static);
    }
    return result;
}

void io_ros2_camera_close(io_ros2_camera *c)
{
    io_ros_encoder_free(&c->encoder);
    io_byte_buffer_free(&c->buffer);
    rlf_free(c->units);
    c->units = NULL;
}

/* ---- messages ------------------------------------------------------------------------------- */

static io_cdr_writer begin(io_ros2_camera *c)
{
    c->buffer.size = 0;
    return io_cdr_begin(&c->buffer);
}

static rlf_result send(io_ros2_camera *c, const io_ros2_writer *writer, rlf_result result)
{
    result = result == RLF_OK ? io_byte_buffer_check(&c->buffer) : result;
    if (result != RLF_OK) {
        return result;
    }
    const bool is_sent = io_ros2_write(writer, c->buffer.data, c->buffer.size);
    c->messages += is_sent ? 1 : 0;
    c->dropped += is_sent ? 0 : 1;
    c->bytes += is_sent ? c->buffer.size : 0;
    return RLF_OK;
}

static rlf_result send_info(io_ros2_camera *c, const io_ros2_writer *writer,
                            const io_ros_header *header, const rlf_camera *camera)
{
    io_cdr_writer cdr = begin(c);
    io_ros_write_camera_info(&cdr, header, camera);
    return send(c, writer, RLF_OK);
}

static rlf_result send_transform(io_ros2_camera *c, int64_t stamp_ns)
{
    io_ros_transform t = {.stamp_ns = stamp_ns, .T_parent_child = c->encoder.rig.T_color_depth};
    memcpy(t.parent, c->color_frame, sizeof(t.parent));
    memcpy(t.child, c->depth_frame, sizeof(t.child));
    io_cdr_writer cdr = begin(c);
    io_ros_write_tf(&cdr, &t, 1);
    c->is_tf_sent = true;
    return send(c, &c->tf_static, RLF_OK);
}

/* ---- depth ---------------------------------------------------------------------------------- */

/* The frame's depth in other units: as metres, or rounded to millimetres, since RVL has counts
 * alone. */
static rlf_frame convert(io_ros2_camera *c, const rlf_frame *frame, bool to_metres)
{
    const rlf_camera *camera = &c->encoder.rig.depth;
    rlf_frame out = *frame;
    const double per_metre = frame->depth_f32 != NULL ? 1.0 : frame->depth_units_per_metre;
    for (int32_t y = 0; y < camera->height; y++) {
        const char *row = frame->depth_f32 != NULL ? (const char *)frame->depth_f32
                                                   : (const char *)frame->depth_u16;
        row += (ptrdiff_t)y * frame->depth_stride;
        for (int32_t x = 0; x < camera->width; x++) {
            const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            const double count = frame->depth_f32 != NULL
                                     ? (double)((const float *)(const void *)row)[x]
                                     : (double)((const uint16_t *)(const void *)row)[x];
            const double mm = count / per_metre * MM_PER_M + 0.5;
            if (to_metres) {
                ((float *)c->units)[i] = (float)(count / per_metre);
            } else {
                ((uint16_t *)c->units)[i] = mm > 0.5 && mm < 65536.0 ? (uint16_t)mm : 0;
            }
        }
    }
    out.depth_f32 = to_metres ? c->units : NULL;
    out.depth_u16 = to_metres ? NULL : c->units;
    out.depth_stride = (ptrdiff_t)camera->width * (to_metres ? 4 : 2);
    out.depth_units_per_metre = to_metres ? 0.0 : MM_PER_M;
    return out;
}

static rlf_result send_depth(io_ros2_camera *c, const rlf_frame *frame, int64_t stamp_ns)
{
    const bool is_mm = frame->depth_u16 != NULL && frame->depth_units_per_metre == MM_PER_M;
    const bool is_aligned = (frame->flags & RLF_FRAME_ALIGNED) != 0;
    const io_ros_header header =
        io_ros_header_at(stamp_ns, is_aligned ? c->color_frame : c->depth_frame);
    rlf_result result = send_info(c, &c->depth_info, &header, &c->encoder.rig.depth);
    if (result == RLF_OK && io_ros2_writer_is_read(&c->depth)) {
        io_cdr_writer cdr = begin(c);
        const rlf_frame to = is_mm || frame->depth_f32 != NULL ? *frame : convert(c, frame, true);
        io_ros_write_depth(&c->encoder, &to, &header, &cdr);
        result = send(c, &c->depth, RLF_OK);
    }
    if (result == RLF_OK && io_ros2_writer_is_read(&c->depth_packed)) {
        io_cdr_writer cdr = begin(c);
        const rlf_frame to = is_mm ? *frame : convert(c, frame, false);
        result = io_ros_write_counts(&c->encoder, &to, &header, &cdr);
        result = send(c, &c->depth_packed, result);
    }
    return result;
}

static rlf_result send_color(io_ros2_camera *c, const rlf_image_rgba8 *image, int64_t stamp_ns)
{
    const io_ros_header header = io_ros_header_at(stamp_ns, c->color_frame);
    rlf_result result = send_info(c, &c->color_info, &header, &c->encoder.rig.color);
    if (result == RLF_OK && io_ros2_writer_is_read(&c->color)) {
        io_cdr_writer cdr = begin(c);
        io_ros_write_color(image, &header, &cdr);
        result = send(c, &c->color, RLF_OK);
    }
    if (result == RLF_OK && io_ros2_writer_is_read(&c->color_packed)) {
        io_cdr_writer cdr = begin(c);
        result = io_ros_write_compressed(&c->encoder, image, &header, &cdr);
        result = send(c, &c->color_packed, result);
    }
    return result;
}

rlf_result io_ros2_camera_send(io_ros2_camera *c, const rlf_frame *frame, int64_t offset_ns)
{
    const int64_t stamp_ns = frame->time_ns + offset_ns;
    rlf_result result = RLF_OK;
    const bool has_color = c->encoder.rig.has_color && frame->color.data != NULL;
    if (c->encoder.rig.has_color && !c->is_tf_sent) {
        result = send_transform(c, stamp_ns);
    }
    result = result == RLF_OK ? send_depth(c, frame, stamp_ns) : result;
    const int64_t color_ns = frame->color_time_ns != 0 ? frame->color_time_ns : frame->time_ns;
    if (result == RLF_OK && has_color && color_ns + offset_ns != c->last_color_ns) {
        c->last_color_ns = color_ns + offset_ns; /* the same picture is not sent twice */
        result = send_color(c, &frame->color, c->last_color_ns);
    }
    return result;
}

/* ---- `relief record SOURCE ros2:/camera`: a machine that lends its camera to others -----------
 */

typedef struct host {
    io_ros2_node *node;
    io_ros2_camera camera;
    io_ros2_clock clock;
} host;

static rlf_result host_add(void *self, const rlf_frame *frame)
{
    host *h = self;
    const int64_t offset_ns = io_ros2_clock_offset(&h->clock, frame->time_ns, io_ros2_now());
    return io_ros2_camera_send(&h->camera, frame, offset_ns);
}

static uint64_t host_bytes(const void *self)
{
    return ((const host *)self)->camera.bytes;
}

static rlf_result host_close(void *self, rlf_recording_status *status)
{
    host *h = self;
    status->bytes = h->camera.bytes;
    if (h->camera.dropped > 0) {
        rlf_log(RLF_LOG_WARNING, "ros2: %llu messages were not sent: a reader was too slow",
                (unsigned long long)h->camera.dropped);
    }
    io_ros2_node_close(&h->node);
    io_ros2_camera_close(&h->camera);
    rlf_free(h);
    return RLF_OK;
}

static rlf_result open_all(host *h, const char *path, const rlf_source_info *info,
                           const rlf_recording_def *def)
{
    io_ros2_target target;
    rlf_result result = io_ros2_target_read(path, &target);
    result = result == RLF_OK ? io_ros2_node_open(path, &target.place, &h->node) : result;
    return result == RLF_OK ? io_ros2_camera_open(h->node, target.name, &info->rig, def, &h->camera)
                            : result;
}

rlf_result io_ros2_sink_open(const char *path, const rlf_source_info *info,
                             const rlf_recording_def *def, io_sink *out)
{
    host *h = rlf_alloc(sizeof(*h));
    if (h == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = open_all(h, path, info, def);
    if (result != RLF_OK) {
        io_ros2_node_close(&h->node);
        io_ros2_camera_close(&h->camera);
        rlf_free(h);
        return result;
    }
    *out = (io_sink){.add = host_add, .close = host_close, .bytes = host_bytes, .self = h};
    return RLF_OK;
}
