/* What a camera of ROS 2 is: its topics, and the first messages of each, which are read as those of
 * a recording are. */
#ifndef RLF_IO_ROS2_FIND_CAMERA_H
#define RLF_IO_ROS2_FIND_CAMERA_H

#include "io/ros/recording.h"
#include "io/ros2/ros2.h"
#include "relief/backend.h"

/* ---- which topics ---- */

/* What the user asks for. */
typedef struct io_ros2_wish {
    const char *place;         /* topics below this name; "" = all */
    const char *depth, *color; /* topics; NULL = not said */
    bool is_packed;            /* compressed pictures before plain ones */
} io_ros2_wish;

bool io_ros2_is_below(const char *topic, const char *place);
/* Writes the indexes of those to read: pictures, their calibration, /tf_static. */
int32_t io_ros2_choose_topics(const io_ros2_topic *topics, int32_t count, const io_ros2_wish *wish,
                              int32_t *out, int32_t capacity);
/* Whether there are pictures to look at already. */
bool io_ros2_has_depth(const io_ros2_topic *topics, int32_t count, const io_ros2_wish *wish);
/* The camera that a topic of depth belongs to: "/camera" of "/camera/depth/image_raw". False for
 * other topics. */
bool io_ros2_camera_of(const io_ros2_topic *topic, char *out, size_t size);

/* ---- their first messages ---- */

#define IO_ROS2_CHANNELS_MAX 48
#define IO_ROS2_FIRST_MAX 16 /* messages kept of a topic: of tf_static, and a few of others */

typedef struct io_ros2_channel {
    io_ros2_topic topic;
    io_ros_type type;
    io_ros2_reader reader;
    io_ros2_message messages[IO_ROS2_FIRST_MAX];
    int32_t kept, seen;
    int64_t last_stamp_ns, interval_ns; /* shortest of two stamps; 0 = not known */
    int64_t clock_ns; /* least of arrival less sending, by the two clocks; INT64_MAX = not known */
} io_ros2_channel;

typedef struct io_ros2_found {
    io_ros2_channel channels[IO_ROS2_CHANNELS_MAX];
    int32_t count;
} io_ros2_found;

/* Waits for the camera to be found, and for a few messages of each of its topics; a second in all.
 * RLF_ERROR_DEVICE with one line when there is none. `out` is zero; free it whatever comes back. */
rlf_result io_ros2_find_camera(io_ros2_node *node, const char *source, const io_ros2_wish *wish,
                               io_ros2_found *out);
void io_ros2_found_free(io_ros2_found *found);
/* As a log of messages, which borrows from it; io_ros_log_free it. */
rlf_result io_ros2_found_log(io_ros2_found *found, const char *source, io_ros_log *out);

/* A back end's `list`: cameras whose depth is published, within a fifth of a second. */
int32_t io_ros2_list(rlf_source_entry *out, int32_t capacity);

/* Nanoseconds since 1970. */
int64_t io_ros2_now(void);

#endif
