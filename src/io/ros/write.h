/* A frame's pictures as ROS 2 messages: for recordings and for the network. */
#ifndef RLF_IO_ROS_WRITE_H
#define RLF_IO_ROS_WRITE_H

#include "io/clip/sink.h"
#include "io/picture/pixels.h"
#include "io/ros/messages.h"
#include "relief/snapshot.h"

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

/* ---- What Relief makes of a frame, as rviz2 shows it ---- */

#define IO_ROS_CLOUD_TYPE "sensor_msgs/msg/PointCloud2"
#define IO_ROS_MARKERS_TYPE "visualization_msgs/msg/MarkerArray"
#define IO_ROS_CLOUD_STEP 24 /* bytes of a point: x y z and its normal, floats */

/* Planes of width x height, row by row. Rays times depth are the points; 0 is a missing one, and
 * becomes NaN. */
typedef struct io_ros_cloud {
    int32_t width, height;
    const float *ray_x, *ray_y, *depth;
    const float *normal_x, *normal_y, *normal_z; /* 0 = not known: NaN */
} io_ros_cloud;

/* PointCloud2, as many rows and columns as the planes. */
void io_ros_write_cloud(io_cdr_writer *w, const io_ros_header *header, const io_ros_cloud *cloud);
/* Image: mono8, 255 where the mask is not 0. */
void io_ros_write_mask(io_cdr_writer *w, const io_ros_header *header, const uint8_t *mask,
                       int32_t width, int32_t height);
/* MarkerArray: every body by its shape; those of the message before are taken away. A hull is drawn
 * by its triangles, which its body borrows. */
void io_ros_write_bodies(io_cdr_writer *w, const io_ros_header *header,
                         const rlf_body_state *bodies, int32_t count);
/* MarkerArray: a dot where something touches, and a line along the push: 10 cm are 1 N s. */
void io_ros_write_contacts(io_cdr_writer *w, const io_ros_header *header,
                           const rlf_contact *contacts, int32_t count);

#endif
