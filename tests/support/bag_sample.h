/* A small ROS 1 bag: two cameras that a driver of a robot would record. Include after cmocka.h. */
#ifndef RLF_TEST_BAG_SAMPLE_H
#define RLF_TEST_BAG_SAMPLE_H

#include "bag_file.h"

#define BAG_SAMPLE_FRAMES 3
#define BAG_SAMPLE_PIXELS (4 * 3)

static const uint32_t bag_depth_size[2] = {4, 3};
static const uint32_t bag_color_size[2] = {2, 2};
static const double bag_sample_f[4] = {4.5, 4.25, 1.5, 1.0};

static inline void bag_sample_infos(bag_file *b)
{
    const double d[8] = {0.1, -0.2, 0.001, -0.002, 0.05, 0.3, 0.03, 0.01};
    byte_file *m = calloc(1, sizeof(*m));
    bag_header(m, 1.0, "depth_frame");
    bag_camera_info(m, bag_depth_size, "plumb_bob", d, 5, bag_sample_f);
    bag_file_connect(b, 0, "/camera/depth/camera_info", "sensor_msgs/CameraInfo");
    bag_file_message(b, 0, 1.0, m);
    bag_header(m, 1.0, "/color_frame");
    bag_camera_info(m, bag_color_size, "rational_polynomial", d, 8, bag_sample_f);
    bag_file_connect(b, 1, "/camera/rgb/camera_info", "sensor_msgs/CameraInfo");
    bag_file_message(b, 1, 1.0, m);
    free(m);
}

/* The colour camera is 50 mm right of the depth camera: both are children of one frame. */
static inline void bag_sample_tf(bag_file *b)
{
    const double q[4] = {0, 0, 0, 1};
    const double t[2][3] = {{0.01, 0, 0}, {0.06, 0, 0}};
    const char *const names[2] = {"depth_frame", "color_frame"};
    byte_file *m = calloc(1, sizeof(*m));
    byte_file *list = calloc(1, sizeof(*list));
    bytes_u32(list, 2);
    for (int i = 0; i < 2; i++) {
        bag_header(m, 1.0, "link");
        bytes_text(m, names[i]);
        bag_transform(m, t[i], q);
        bytes_put(list, m->data, m->size);
    }
    bag_file_connect(b, 2, "/tf_static", "tf2_msgs/TFMessage");
    bag_file_message(b, 2, 1.0, list);
    free(m);
    free(list);
}

/* Frame i: depth 1000 i + pixel, taken at 1 + i / 32 s; colour 10 ms later, red 50 i. */
static inline void bag_sample_frame(bag_file *b, int i)
{
    const double time = 1.0 + i / 32.0;
    uint16_t depth[BAG_SAMPLE_PIXELS];
    uint8_t color[2 * 2 * 3] = {0};
    for (int p = 0; p < BAG_SAMPLE_PIXELS; p++) {
        depth[p] = (uint16_t)(1000 * i + p);
    }
    for (int p = 0; p < 4; p++) {
        color[3 * p] = (uint8_t)(50 * i);
    }
    byte_file *m = calloc(1, sizeof(*m));
    bag_header(m, time, "depth_frame");
    bag_image(m, "16UC1", bag_depth_size, depth, sizeof(depth));
    bag_file_message(b, 3, time + 0.5, m);
    bag_header(m, time + 0.01, "color_frame");
    bag_image(m, "rgb8", bag_color_size, color, sizeof(color));
    bag_file_message(b, 4, time + 0.4, m);
    free(m);
}

static inline void bag_sample_chunk(bag_file *b, int frame)
{
    if (frame == 0) {
        bag_sample_infos(b);
        bag_sample_tf(b);
        bag_file_connect(b, 3, "/camera/depth/image_raw", "sensor_msgs/Image");
        bag_file_connect(b, 4, "/camera/rgb/image_raw", "sensor_msgs/Image");
    }
    bag_sample_frame(b, frame);
}

/* One plain chunk per frame. */
static inline bag_file *bag_sample_make(bool has_index)
{
    bag_file *b = bag_file_new();
    for (int i = 0; i < BAG_SAMPLE_FRAMES; i++) {
        bag_sample_chunk(b, i);
        bag_file_flush(b, "none", NULL, has_index);
    }
    if (has_index) {
        bag_file_finish(b);
    }
    return b;
}

/* The bytes as an LZ4 frame: one block, of literals alone. */
static inline void bag_sample_lz4(const byte_file *plain, byte_file *out)
{
    byte_file *block = calloc(1, sizeof(*block));
    const uint8_t frame[7] = {0x04, 0x22, 0x4D, 0x18, 0x60, 0x40, 0x82};
    bytes_u8(block, 0xF0);
    size_t rest = plain->size - 15;
    for (; rest >= 255; rest -= 255) {
        bytes_u8(block, 255);
    }
    bytes_u8(block, (uint8_t)rest);
    bytes_put(block, plain->data, plain->size);
    out->size = 0;
    bytes_put(out, frame, sizeof(frame));
    bytes_block(out, block->data, block->size);
    bytes_u32(out, 0);
    free(block);
}

#endif
