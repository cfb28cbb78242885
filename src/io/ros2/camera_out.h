/* A camera's topics, as camera drivers of ROS 2 have them. */
#ifndef RLF_IO_ROS2_CAMERA_OUT_H
#define RLF_IO_ROS2_CAMERA_OUT_H

#include "io/ros/frame_write.h"
#include "io/ros2/ros2.h"

/* Below the camera's name: depth/image_raw (16UC1 millimetres, or 32FC1 metres) and its
 * compressedDepth, color/image_raw (rgb8) and its compressed, camera_info beside each; /tf_static.
 * What nobody reads is not made. */
typedef struct io_ros2_camera {
    io_ros2_writer depth, depth_packed, depth_info, color, color_packed, color_info, tf_static;
    io_ros_encoder encoder;
    io_byte_buffer buffer;
    void *units; /* depth in other units: width x height of 4 bytes */
    char depth_frame[IO_ROS_NAME_MAX], color_frame[IO_ROS_NAME_MAX];
    bool is_tf_sent;
    int64_t last_color_ns;
    uint64_t messages, bytes, dropped; /* dropped: a reader was too slow */
} io_ros2_camera;

/* `name`: "/camera". `out` is zero; close it whatever comes back. */
rlf_result io_ros2_camera_open(io_ros2_node *node, const char *name, const rlf_rig *rig,
                               const rlf_recording_def *def, io_ros2_camera *out);
/* All writers are the node's, which is closed first. */
void io_ros2_camera_close(io_ros2_camera *camera);
/* A frame of that rig; offset_ns makes 1970's of its times. */
rlf_result io_ros2_camera_send(io_ros2_camera *camera, const rlf_frame *frame, int64_t offset_ns);

/* Where a camera or a run is published: "ros2:/camera?domain=1&profile=lan". */
typedef struct io_ros2_target {
    io_ros2_place place;
    char name[IO_ROS2_TOPIC_MAX]; /* "/camera" */
} io_ros2_target;

rlf_result io_ros2_target_read(const char *address, io_ros2_target *out);

/* "NAME/PART"; false when it is too long. */
bool io_ros2_name(const char *name, const char *part, char out[IO_ROS2_TOPIC_MAX]);
/* "/front/camera" is "front_camera" in names of frames. */
void io_ros2_frame_name(const char *name, const char *part, char out[IO_ROS_NAME_MAX]);

/* When the clock of frames is another than 1970's: the offset that makes a frame's time `now_ns`,
 * kept while the two clocks go alike. */
typedef struct io_ros2_clock {
    bool has_offset;
    int64_t offset_ns;
} io_ros2_clock;

int64_t io_ros2_clock_offset(io_ros2_clock *clock, int64_t time_ns, int64_t now_ns);

#endif
