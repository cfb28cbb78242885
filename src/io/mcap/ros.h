/* The ROS 2 messages that a recording has: written and read as CDR, with the text of their types.
 */
#ifndef RLF_IO_MCAP_ROS_H
#define RLF_IO_MCAP_ROS_H

#include "io/mcap/cdr.h"
#include "io/ros/camera_info.h"
#include "relief/frame.h"

typedef enum io_ros_type {
    IO_ROS_OTHER = 0,
    IO_ROS_IMAGE,
    IO_ROS_COMPRESSED_IMAGE,
    IO_ROS_CAMERA_INFO,
    IO_ROS_TF,
    IO_ROS_POSE_STAMPED,
    IO_ROS_STRING,
    IO_ROS_TYPE_COUNT
} io_ros_type;

/* "sensor_msgs/msg/Image" and so on; NULL for IO_ROS_OTHER. */
const char *io_ros_type_name(io_ros_type type);
/* The message definition with those it consists of, as the "ros2msg" encoding wants it. */
const char *io_ros_type_text(io_ros_type type);

typedef struct io_ros_header {
    int64_t stamp_ns;
    char frame_id[IO_ROS_NAME_MAX];
} io_ros_header;

/* sensor_msgs/Image and, with width 0, sensor_msgs/CompressedImage. */
typedef struct io_ros_image {
    io_ros_header header;
    uint32_t width, height, step;
    char encoding[64]; /* or format */
    bool is_bigendian;
    io_cdr_span data;
} io_ros_image;

/* p_parent = T p_child */
typedef struct io_ros_transform {
    int64_t stamp_ns;
    char parent[IO_ROS_NAME_MAX], child[IO_ROS_NAME_MAX];
    rlf_pose T_parent_child;
} io_ros_transform;

/* All return false for bytes that are no such message. */
bool io_ros_read_header(const uint8_t *data, size_t size, io_ros_header *out);
bool io_ros_read_image(const uint8_t *data, size_t size, io_ros_image *out);
bool io_ros_read_compressed(const uint8_t *data, size_t size, io_ros_image *out);
bool io_ros_read_camera_info(const uint8_t *data, size_t size, io_camera_info *out);
/* At most `capacity`; *out_count says how many. */
bool io_ros_read_tf(const uint8_t *data, size_t size, io_ros_transform *out, uint32_t capacity,
                    uint32_t *out_count);
/* std_msgs/String; what has no room in `out` is cut. */
bool io_ros_read_string(const uint8_t *data, size_t size, char *out, size_t capacity);
bool io_ros_read_pose(const uint8_t *data, size_t size, io_ros_header *header, rlf_pose *out);

/* A message up to its bytes; they follow, then io_cdr_end_bytes with what this returns. */
size_t io_ros_begin_image(io_cdr_writer *w, const io_ros_image *image);
size_t io_ros_begin_compressed(io_cdr_writer *w, const io_ros_image *image);
void io_ros_write_camera_info(io_cdr_writer *w, const io_ros_header *header,
                              const rlf_camera *camera);
void io_ros_write_tf(io_cdr_writer *w, const io_ros_transform *transforms, uint32_t count);
void io_ros_write_pose(io_cdr_writer *w, const io_ros_header *header, const rlf_pose *pose);

#endif
