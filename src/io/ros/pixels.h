/* Pictures in ROS messages: what they are, and their pixels. */
#ifndef RLF_IO_ROS_PIXELS_H
#define RLF_IO_ROS_PIXELS_H

#include "io/codec/rvl.h"
#include "io/file.h"
#include "io/ros/messages.h"
#include "relief/image.h"

typedef enum io_ros_pixels {
    IO_ROS_UNKNOWN = 0,
    IO_ROS_DEPTH_U16,     /* 16UC1, mono16 */
    IO_ROS_DEPTH_F32,     /* 32FC1 */
    IO_ROS_DEPTH_RVL,     /* compressedDepth of compressed_depth_image_transport */
    IO_ROS_DEPTH_PNG,     /* the same as PNG, and PNG of 16 bits */
    IO_ROS_DEPTH_RVL_F32, /* the same of 32FC1: inverse depth in 16 bits */
    IO_ROS_DEPTH_PNG_F32,
    IO_ROS_MONO8,
    IO_ROS_COLOR,  /* what io_pixels_to_rgba knows */
    IO_ROS_PICTURE /* PNG or JPEG */
} io_ros_pixels;

/* By the encoding of an Image, or the format of a CompressedImage. */
io_ros_pixels io_ros_pixels_of(const io_ros_image *image, bool is_compressed);
bool io_ros_is_depth(io_ros_pixels pixels);
/* Whether it comes as metres. */
bool io_ros_is_metres(io_ros_pixels pixels);

/* Width and height of a picture, also of one that says them only inside; false when it does not. */
bool io_ros_picture_size(const io_ros_image *image, io_ros_pixels pixels, int32_t *out_width,
                         int32_t *out_height);

/* Work memory for decoding. */
typedef struct io_ros_decoder {
    io_rvl rvl;
    const char *name;   /* for error lines */
    bool rounds_metres; /* to counts of IO_PIXELS_FLOAT_UNITS */
    uint16_t *counts;   /* of inverse depth: width x height; NULL = never needed */
} io_ros_decoder;

/* Depth as uint16_t or float, width x height without padding. Metres come as float unless the
 * decoder rounds them. */
rlf_result io_ros_decode_depth(const io_ros_decoder *decoder, const io_ros_image *image,
                               io_ros_pixels pixels, int32_t width, int32_t height, void *out);
rlf_result io_ros_decode_color(const io_ros_decoder *decoder, const io_ros_image *image,
                               io_ros_pixels pixels, const rlf_image_rgba8 *out);

#endif
