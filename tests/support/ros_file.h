/* Writes small recordings of ROS topics: the same content as an MCAP file of ROS 2 and as a bag of
 * ROS 1. Include after cmocka.h. */
#ifndef RLF_TEST_ROS_FILE_H
#define RLF_TEST_ROS_FILE_H

#include "test.h"
#include "bag_file.h"
#include "io/ros/messages.h"
#include "io/mcap/mcap.h"
#include "io_support.h"

#define ROS_TIME_S 1000

/* Both at once; a topic has the same number in both. */
typedef struct ros_file {
    io_mcap_writer *mcap;
    bag_file *bag;
    int32_t ms; /* of the next pictures, behind ROS_TIME_S */
} ros_file;

static inline ros_file ros_file_open(const char *stem)
{
    char name[64];
    ros_file f = {.bag = bag_file_new()};
    snprintf(name, sizeof(name), "%s.mcap", stem);
    assert_int_equal(io_mcap_writer_create(test_path(name), IO_PACKING_NONE, &f.mcap), RLF_OK);
    return f;
}

static inline void ros_file_close(ros_file *f, const char *stem)
{
    char name[64];
    assert_int_equal(io_mcap_writer_close(&f->mcap, NULL), RLF_OK);
    bag_file_flush(f->bag, "none", NULL, true);
    bag_file_finish(f->bag);
    snprintf(name, sizeof(name), "%s.bag", stem);
    test_write(name, f->bag->file.data, f->bag->file.size);
    free(f->bag);
}

static inline uint16_t ros_topic(ros_file *f, io_ros_type type, const char *topic)
{
    const char *ros1 = type == IO_ROS_IMAGE              ? "sensor_msgs/Image"
                       : type == IO_ROS_COMPRESSED_IMAGE ? "sensor_msgs/CompressedImage"
                       : type == IO_ROS_CAMERA_INFO      ? "sensor_msgs/CameraInfo"
                                                         : "tf2_msgs/TFMessage";
    io_mcap_add_schema(f->mcap, io_ros_type_name(type), io_ros_type_text(type));
    const uint16_t id = io_mcap_add_channel(f->mcap, topic, "");
    bag_file_connect(f->bag, id, topic, ros1);
    return id;
}

/* Width 0: a compressed one. */
static inline void ros_image(ros_file *f, uint16_t topic, const char *frame_id,
                             const char *encoding, const uint32_t size[2], const void *data,
                             size_t bytes)
{
    io_ros_image image = {.width = size[0], .height = size[1]};
    image.step = size[1] > 0 ? (uint32_t)(bytes / size[1]) : 0;
    image.header.stamp_ns = (ROS_TIME_S * INT64_C(1000) + f->ms) * 1000000;
    const double seconds = ROS_TIME_S + 1e-3 * f->ms;
    strcpy(image.header.frame_id, frame_id);
    strcpy(image.encoding, encoding);
    io_cdr_writer cdr = io_cdr_begin(io_mcap_begin(f->mcap, topic, image.header.stamp_ns));
    const size_t begin =
        size[0] == 0 ? io_ros_begin_compressed(&cdr, &image) : io_ros_begin_image(&cdr, &image);
    io_byte_buffer_add(cdr.buffer, data, bytes);
    io_cdr_end_bytes(&cdr, begin);
    io_mcap_end(f->mcap, true);

    byte_file *m = calloc(1, sizeof(*m));
    bag_header(m, seconds, frame_id);
    if (size[0] == 0) {
        bytes_text(m, encoding);
        bytes_block(m, data, bytes);
    } else {
        bag_image(m, encoding, size, data, bytes);
    }
    bag_file_message(f->bag, topic, seconds, m);
    free(m);
}

/* What both write alike, in CameraInfo's order behind the header. */
static inline void ros_info(ros_file *f, uint16_t topic, const io_camera_info *info)
{
    const io_camera_window *w = &info->window;
    const uint32_t window[6] = {w->binning_x, w->binning_y, w->x, w->y, w->height, w->width};
    io_cdr_writer cdr =
        io_cdr_begin(io_mcap_begin(f->mcap, topic, ROS_TIME_S * INT64_C(1000000000)));
    byte_file *m = calloc(1, sizeof(*m));
    io_cdr_put_u32(&cdr, ROS_TIME_S);
    io_cdr_put_u32(&cdr, 0);
    io_cdr_put_text(&cdr, info->frame_id);
    bag_header(m, ROS_TIME_S, info->frame_id);
    io_cdr_put_u32(&cdr, info->height);
    io_cdr_put_u32(&cdr, info->width);
    io_cdr_put_text(&cdr, info->model);
    io_cdr_put_u32(&cdr, info->d_count);
    io_cdr_put_doubles(&cdr, info->d, info->d_count);
    io_cdr_put_doubles(&cdr, info->k, 9);
    io_cdr_put_doubles(&cdr, info->r, 9);
    io_cdr_put_doubles(&cdr, info->p, 12);
    bytes_u32(m, info->height);
    bytes_u32(m, info->width);
    bytes_text(m, info->model);
    bytes_u32(m, info->d_count);
    bytes_put(m, info->d, info->d_count * sizeof(double));
    bytes_put(m, info->k, sizeof(info->k));
    bytes_put(m, info->r, sizeof(info->r));
    bytes_put(m, info->p, sizeof(info->p));
    for (int i = 0; i < 6; i++) {
        io_cdr_put_u32(&cdr, window[i]);
        bytes_u32(m, window[i]);
    }
    io_cdr_put_u8(&cdr, 0);
    bytes_u8(m, 0);
    io_mcap_end(f->mcap, true);
    bag_file_message(f->bag, topic, ROS_TIME_S, m);
    free(m);
}

/* `child` is x metres to the right of `parent`. */
static inline void ros_transform(ros_file *f, uint16_t topic, const char *parent, const char *child,
                                 double x)
{
    const double t[3] = {x, 0, 0}, q[4] = {0, 0, 0, 1};
    io_ros_transform transform = {.T_parent_child = rlf_pose_identity()};
    strcpy(transform.parent, parent);
    strcpy(transform.child, child);
    transform.T_parent_child.p.x = x;
    io_cdr_writer cdr =
        io_cdr_begin(io_mcap_begin(f->mcap, topic, ROS_TIME_S * INT64_C(1000000000)));
    io_ros_write_tf(&cdr, &transform, 1);
    io_mcap_end(f->mcap, true);

    byte_file *m = calloc(1, sizeof(*m));
    byte_file *list = calloc(1, sizeof(*list));
    bytes_u32(list, 1);
    bag_header(m, ROS_TIME_S, parent);
    bytes_text(m, child);
    bag_transform(m, t, q);
    bytes_put(list, m->data, m->size);
    bag_file_message(f->bag, topic, ROS_TIME_S, list);
    free(m);
    free(list);
}

/* A lens without distortion: K = P. */
static inline io_camera_info ros_lens(const char *frame_id, const uint32_t size[2], double f)
{
    const double cx = 0.5 * size[0] - 0.5, cy = 0.5 * size[1] - 0.5;
    io_camera_info info = {.width = size[0],
                           .height = size[1],
                           .model = "plumb_bob",
                           .d_count = 5,
                           .k = {f, 0, cx, 0, f, cy, 0, 0, 1},
                           .r = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                           .p = {f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0}};
    strcpy(info.frame_id, frame_id);
    return info;
}

#endif
