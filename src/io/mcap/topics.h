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

/* Depth: the topic wished for, else the one with most pictures. Colour: the one wished for, else
 * the same, colours before grey. Fails when there is no depth. */
rlf_result io_mcap_find_streams(io_mcap_reader *reader, const char *path,
                                const io_mcap_wishes *wishes, io_mcap_stream *depth,
                                io_mcap_stream *color);

/* The camera of a stream from the CameraInfo beside it, or with its frame_id, or of its size. */
bool io_mcap_find_camera(io_mcap_reader *reader, const char *path, const io_mcap_stream *stream,
                         rlf_camera *out);

/* From /tf_static; false when the two frames are not joined. */
bool io_mcap_find_transform(io_mcap_reader *reader, const char *from, const char *to,
                            rlf_pose *out_T_to_from);

#endif
