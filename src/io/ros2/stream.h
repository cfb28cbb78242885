/* Depth or colour of a running camera: message by message into a picture. */
#ifndef RLF_IO_ROS2_STREAM_H
#define RLF_IO_ROS2_STREAM_H

#include "io/live/driver.h"
#include "io/ros2/gather.h"

typedef struct io_ros2_stream {
    const char *source, *topic; /* for lines */
    io_ros2_reader reader;
    bool is_compressed, is_told;
    bool has_rival; /* another publisher's message came since the last of its own */
    io_ros_pixels pixels;
    uint64_t writer; /* whose messages are taken; 0 = the first that comes */
    int64_t heard_ns;
    uint64_t *damaged; /* counts what is refused */
} io_ros2_stream;

/* The next message that is to be used; false when nothing waits. Messages of a second publisher, of
 * another kind of picture, and bytes that are none are refused and counted. `held` is released by
 * the caller. */
bool io_ros2_stream_take(io_ros2_stream *stream, io_ros2_message *held, io_ros_image *out);
/* Counts a picture that could not be decoded, with the error line that is left. */
void io_ros2_stream_refuse(io_ros2_stream *stream, const char *line);

#endif
