/* Which topics of a ROS 2 recording are the depth and the colour pictures, and their calibration.
 */
#ifndef RLF_IO_MCAP_TOPICS_H
#define RLF_IO_MCAP_TOPICS_H

#include "io/mcap/pixels.h"
#include "io/mcap/read.h"

typedef struct io_mcap_stream {
    int32_t channel; /* -1 = none */
    bool is_compressed;
    io_ros_pixels pixels;
    int32_t width, height;
    char frame_id[IO_ROS_NAME_MAX];
} io_mcap_stream;

/* What the user or the file says about the topics; NULL = by type and encoding. */
typedef struct io_mcap_wishes {
    const char *depth, *color;
} io_mcap_wishes;

/* Reads message `index` of a stream as a picture; its bytes stay valid until the next message. */
rlf_result io_mcap_read_picture(io_mcap_reader *reader, const io_mcap_stream *stream, int32_t index,
                                io_ros_image *out);

/* The topics of pictures and of calibrations. */
typedef struct io_mcap_topics io_mcap_topics;

rlf_result io_mcap_topics_create(io_mcap_reader *reader, const char *path, io_mcap_topics **out);
void io_mcap_topics_destroy(io_mcap_topics **topics);

/* The two streams; color->channel -1 = none. Fails when there is no depth. */
rlf_result io_mcap_find_streams(const io_mcap_topics *topics, const io_mcap_wishes *wishes,
                                io_mcap_stream *depth, io_mcap_stream *color);

/* The camera of a stream from the CameraInfo that describes its pictures. False when there is none
 * that can be used: io_mcap_why_no_camera tells. */
bool io_mcap_find_camera(const io_mcap_topics *topics, const io_mcap_stream *stream,
                         rlf_camera *out);
const char *io_mcap_why_no_camera(const io_mcap_topics *topics, const io_mcap_stream *stream,
                                  char *out, size_t size);

#endif
