/* A frame's pictures as ROS 2 messages: for recordings and for the network. */
#ifndef RLF_IO_ROS_FRAME_WRITE_H
#define RLF_IO_ROS_FRAME_WRITE_H

#include "io/clip/sink.h"
#include "io/picture/pixels.h"
#include "io/ros/messages.h"

/* Work memory; one thread at a time. */
typedef struct io_ros_encoder {
    rlf_rig rig;
    rlf_depth_codec depth_codec;
    int32_t jpeg_quality; /* 0 = PNG */
    io_rvl rvl;
    io_jpeg_encoder *jpeg;
    void *scratch; /* rows without padding */
} io_ros_encoder;

rlf_result io_ros_encoder_init(io_ros_encoder *encoder, const rlf_rig *rig,
                               const rlf_recording_def *def);
/* One that was never made is allowed, when it is zero. */
void io_ros_encoder_free(io_ros_encoder *encoder);

io_ros_header io_ros_header_at(int64_t time_ns, const char *frame_id);

/* Each appends one message. */

/* CompressedImage: 16UC1, compressedDepth by RVL or PNG, of the frame's counts. */
rlf_result io_ros_write_counts(io_ros_encoder *encoder, const rlf_frame *frame,
                               const io_ros_header *header, io_cdr_writer *cdr);
/* Image: 32FC1 of metres, or 16UC1 of the frame's counts. */
void io_ros_write_depth(io_ros_encoder *encoder, const rlf_frame *frame,
                        const io_ros_header *header, io_cdr_writer *cdr);
/* CompressedImage: JPEG or PNG. */
rlf_result io_ros_write_compressed(io_ros_encoder *encoder, const rlf_image_rgba8 *image,
                                   const io_ros_header *header, io_cdr_writer *cdr);
/* Image: rgb8. */
void io_ros_write_color(const rlf_image_rgba8 *image, const io_ros_header *header,
                        io_cdr_writer *cdr);

#endif
