/* A camera's first messages from the network: any bytes give a camera and pictures of its size, or
 * an error line. A message is its topic's number, its size in two bytes, and its bytes. */
#include "fuzz.h"

#include "io/ros/write.h"
#include "io/ros2/find_camera.h"
#include "relief/io.h"

#include <stdio.h>
#include <stdlib.h>

#define W 8
#define H 6
#define TOPICS 6

static const struct {
    const char *name;
    io_ros_type type;
} topics[TOPICS] = {{"/c/depth/image_raw", IO_ROS_IMAGE},
                    {"/c/depth/image_raw/compressedDepth", IO_ROS_COMPRESSED_IMAGE},
                    {"/c/depth/camera_info", IO_ROS_CAMERA_INFO},
                    {"/c/color/image_raw", IO_ROS_IMAGE},
                    {"/c/color/camera_info", IO_ROS_CAMERA_INFO},
                    {"/tf_static", IO_ROS_TF}};

/* ---- seeds ---------------------------------------------------------------------------------- */

static void add(uint8_t *out, size_t *size, uint8_t topic, const io_byte_buffer *b)
{
    out[*size] = topic;
    out[*size + 1] = (uint8_t)b->size;
    out[*size + 2] = (uint8_t)(b->size >> 8);
    memcpy(out + *size + 3, b->data, b->size);
    *size += 3 + b->size;
}

static io_cdr_writer begin(io_byte_buffer *b)
{
    b->size = 0;
    return io_cdr_begin(b);
}

/* Odd ones are packed; from 2 on there is colour; 4 and 5 have metres. */
size_t fuzz_seed(int index, uint8_t *out, size_t capacity)
{
    static uint16_t depth[W * H];
    static float metres[W * H];
    static uint8_t rgba[W * H * 4];
    const rlf_camera camera = {.width = W, .height = H, .fx = 8, .fy = 8, .cx = 4, .cy = 3};
    rlf_rig rig = rlf_rig_default();
    rig.depth = rig.color = camera;
    const rlf_recording_def def = rlf_recording_def_default();
    io_ros_encoder encoder;
    io_byte_buffer b = {0};
    size_t size = 0;
    if (index >= 6 || capacity < 4096 || io_ros_encoder_init(&encoder, &rig, &def) != RLF_OK) {
        return 0;
    }
    for (int i = 0; i < W * H; i++) {
        depth[i] = (uint16_t)(i % 5 == 0 ? 0 : 1000 + i);
        metres[i] = 1.0f + (float)i;
    }
    const bool is_metres = index >= 4;
    const rlf_frame frame = {.depth_u16 = is_metres ? NULL : depth,
                             .depth_f32 = is_metres ? metres : NULL,
                             .depth_stride = W * (is_metres ? 4 : 2),
                             .depth_units_per_metre = 1000};
    const io_ros_header d = io_ros_header_at(1000000000, "d"),
                        c = io_ros_header_at(1000000000, "c");
    io_cdr_writer w = begin(&b);
    if (index % 2 == 0 || is_metres) {
        io_ros_write_depth(&encoder, &frame, &d, &w);
    } else {
        (void)io_ros_write_counts(&encoder, &frame, &d, &w);
    }
    add(out, &size, index % 2 == 0 || is_metres ? 0 : 1, &b);
    w = begin(&b);
    io_ros_write_camera_info(&w, &d, &camera);
    add(out, &size, 2, &b);
    if (index >= 2) {
        const rlf_image_rgba8 image = {rgba, W, H, W * 4};
        w = begin(&b);
        io_ros_write_color(&image, &c, &w);
        add(out, &size, 3, &b);
        w = begin(&b);
        io_ros_write_camera_info(&w, &c, &camera);
        add(out, &size, 4, &b);
        const io_ros_transform t = {
            .parent = "c", .child = "d", .T_parent_child = rlf_pose_identity()};
        w = begin(&b);
        io_ros_write_tf(&w, &t, 1);
        add(out, &size, 5, &b);
    }
    io_byte_buffer_free(&b);
    io_ros_encoder_free(&encoder);
    return size;
}

/* ---- the camera ----------------------------------------------------------------------------- */

static void take_apart(const uint8_t *data, size_t size, io_ros2_found *g)
{
    g->count = TOPICS;
    for (int i = 0; i < TOPICS; i++) {
        snprintf(g->channels[i].topic.name, sizeof(g->channels[i].topic.name), "%s",
                 topics[i].name);
        g->channels[i].type = topics[i].type;
    }
    while (size >= 3) {
        io_ros2_channel *c = &g->channels[data[0] % TOPICS];
        const size_t told = (size_t)data[1] | (size_t)data[2] << 8;
        const size_t length = told < size - 3 ? told : size - 3;
        if (c->kept < IO_ROS2_FIRST_MAX) {
            c->messages[c->kept++] = (io_ros2_message){.data = data + 3, .size = length};
        }
        data += 3 + length;
        size -= 3 + length;
    }
}

static void decode(io_ros_recording *r)
{
    const rlf_camera *d = &r->rig.depth, *c = &r->rig.color;
    io_ros_image image;
    if (io_ros_read_picture(&r->log, &r->depth, 0, &image) == RLF_OK) {
        uint16_t *out = rlf_alloc_array((size_t)d->width * (size_t)d->height, sizeof(*out));
        if (out != NULL) {
            (void)io_ros_decode_depth(&r->decoder, &image, r->depth.pixels, d->width, d->height,
                                      out);
        }
        rlf_free(out);
    }
    if (r->rig.has_color && io_ros_read_picture(&r->log, &r->color, 0, &image) == RLF_OK) {
        const rlf_image_rgba8 out = {rlf_alloc_array((size_t)c->width * (size_t)c->height, 4),
                                     c->width, c->height, (ptrdiff_t)c->width * 4};
        if (out.data != NULL) {
            (void)io_ros_decode_color(&r->decoder, &image, r->color.pixels, &out);
        }
        rlf_free(out.data);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static io_ros2_found found;
    memset(&found, 0, sizeof(found));
    take_apart(data, size, &found);
    const rlf_address address = {.source = "ros2:/c", .place = "/c"};
    io_ros_recording r;
    memset(&r, 0, sizeof(r));
    if (io_ros2_found_log(&found, "ros2:/c", &r.log) == RLF_OK &&
        io_ros_prepare(&r, &address) == RLF_OK) {
        r.decoder.rounds_metres = true;
        decode(&r);
    } else if (rlf_error_text()[0] == '\0') {
        abort();
    }
    io_ros_recording_free(&r);
    return 0;
}
