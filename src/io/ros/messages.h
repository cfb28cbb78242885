/* The messages of ROS that a recording has: read as ROS 1 and ROS 2 serialise them, and written as
 * ROS 2, with the text of their types. */
#ifndef RLF_IO_ROS_MESSAGES_H
#define RLF_IO_ROS_MESSAGES_H

#include "io/calibration/calibration.h"
#include "io/picture/picture.h"
#include "relief/frame.h"

/* Common Data Representation as ROS 2 has it: XCDR1 (OMG DDS-XTypes 1.3, 7.4), every number aligned
 * to its size from the first byte behind the head of 4. */

/* ---- writing: appends to a buffer ------------------------------------------------------------ */

typedef struct io_cdr_writer {
    io_byte_buffer *buffer;
    size_t start; /* of what is aligned */
} io_cdr_writer;

io_cdr_writer io_cdr_begin(io_byte_buffer *buffer);
void io_cdr_put_u8(io_cdr_writer *w, uint8_t value);
void io_cdr_put_u32(io_cdr_writer *w, uint32_t value);
void io_cdr_put_doubles(io_cdr_writer *w, const double *values, size_t count);
/* With its ending zero, as CDR has it. */
void io_cdr_put_text(io_cdr_writer *w, const char *text);
/* A sequence of bytes: what is appended to the buffer between the two calls. */
size_t io_cdr_begin_bytes(io_cdr_writer *w);
void io_cdr_end_bytes(io_cdr_writer *w, size_t begin);

/* ---- reading: any bytes ---------------------------------------------------------------------- */

/* Past the end everything is 0 and `is_bad` is set. */
typedef struct io_cdr_reader {
    const uint8_t *data;
    size_t size, position;
    uint32_t align_max;
    bool is_swapped, is_ros1, is_bad;
} io_cdr_reader;

/* A piece of the message; borrowed from it. */
typedef struct io_cdr_span {
    const uint8_t *data;
    size_t size;
} io_cdr_span;

io_cdr_reader io_cdr_open(const uint8_t *data, size_t size);
io_cdr_reader io_ros1_open(const uint8_t *data, size_t size);
uint8_t io_cdr_get_u8(io_cdr_reader *r);
uint32_t io_cdr_get_u32(io_cdr_reader *r);
float io_cdr_get_float(io_cdr_reader *r);
void io_cdr_get_doubles(io_cdr_reader *r, double *out, size_t count);
/* Cut to what fits. */
void io_cdr_get_text(io_cdr_reader *r, char *out, size_t size);
io_cdr_span io_cdr_get_bytes(io_cdr_reader *r);

/* ---- sensor_msgs/CameraInfo of ROS 1 and 2: what it says of a lens ---- */

#define IO_ROS_NAME_MAX 128 /* of a frame, bytes with the ending zero */
#define IO_ROS_DISTORTION_MAX                                                                      \
    14 /* OpenCV's longest model; thin prism and tilt are its last six                             \
        */

typedef struct io_camera_info {
    char frame_id[IO_ROS_NAME_MAX];
    uint32_t width, height; /* of the whole picture, before the window */
    char model[48];
    double d[IO_ROS_DISTORTION_MAX];
    uint32_t d_count; /* as the message says; no more than fit are kept */
    double k[9], r[9], p[12];
    io_camera_window window; /* region of interest, binning */
} io_camera_info;

/* Size of the pictures it describes: its region of interest, with pixels joined by its binning
 * (REP 104). False when it describes none. */
bool io_camera_info_size(const io_camera_info *info, int32_t *out_width, int32_t *out_height);

/* Fits the camera's distortion to an equidistant lens of these coefficients; fx, fy, cx, cy and the
 * size are given. Returns the largest distance that is left, pixels; infinity when nothing fits. */
double io_equidistant_lens(const double k[4], rlf_camera *camera);

/* The camera of these pictures. Of a topic whose name says "rect" that is P, free of distortion;
 * else K and D. A warning tells what of the lens cannot be used. RLF_ERROR_FORMAT when it is not
 * calibrated or describes no picture. `name`: the file, for these lines. */
rlf_result io_camera_info_lens(const io_camera_info *info, const char *name, const char *topic,
                               rlf_camera *out);

typedef enum io_ros_type {
    IO_ROS_OTHER = 0,
    IO_ROS_IMAGE,
    IO_ROS_COMPRESSED_IMAGE,
    IO_ROS_CAMERA_INFO,
    IO_ROS_TF,
    IO_ROS_POSE_STAMPED,
    IO_ROS_STRING,
    IO_ROS_TYPE_COUNT,
    /* Of RealSense's bags alone. */
    IO_ROS_TRANSFORM,
    IO_ROS_FLOAT,
    IO_ROS_KEY_VALUE
} io_ros_type;

/* "sensor_msgs/msg/Image" and so on: of those before IO_ROS_TYPE_COUNT; NULL for IO_ROS_OTHER. */
const char *io_ros_type_name(io_ros_type type);
/* The message definition with those it consists of, as the "ros2msg" encoding wants it. */
const char *io_ros_type_text(io_ros_type type);

/* By the name that ROS 1 has for it. */
io_ros_type io_ros1_type_of(const char *name);

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
    double units_per_metre; /* RealSense 2.50 and later say them; 0 = not said */
} io_ros_image;

/* p_parent = T p_child */
typedef struct io_ros_transform {
    int64_t stamp_ns;
    char parent[IO_ROS_NAME_MAX], child[IO_ROS_NAME_MAX];
    rlf_pose T_parent_child;
} io_ros_transform;

/* Whether it is a rotation, nearly of unit length, with a place. */
bool io_ros_is_pose(const rlf_pose *pose);

/* All return false for bytes that are no such message; io_cdr_open and io_ros1_open give readers.
 */
/* Of a message that begins with a header. */
bool io_ros_read_stamp(io_cdr_reader r, int64_t *out_ns);
bool io_ros_read_image(io_cdr_reader r, io_ros_image *out);
bool io_ros_read_compressed(io_cdr_reader r, io_ros_image *out);
bool io_ros_read_camera_info(io_cdr_reader r, io_camera_info *out);
/* At most `capacity`; *out_count says how many. */
bool io_ros_read_tf(io_cdr_reader r, io_ros_transform *out, uint32_t capacity, uint32_t *out_count);
/* std_msgs/String; what has no room in `out` is cut. */
bool io_ros_read_string(io_cdr_reader r, char *out, size_t capacity);
bool io_ros_read_transform(io_cdr_reader r, rlf_pose *out); /* geometry_msgs/Transform */
bool io_ros_read_float(io_cdr_reader r, double *out);
/* Copies the value of a diagnostic_msgs/KeyValue; false when it has another key. */
bool io_ros_read_value(io_cdr_reader r, const char *key, char *out, size_t capacity);
bool io_ros_read_pose(io_cdr_reader r, io_ros_header *header, rlf_pose *out);

/* What most messages begin with. */
void io_ros_write_header(io_cdr_writer *w, const io_ros_header *header);
/* A message up to its bytes; they follow, then io_cdr_end_bytes with what this returns. */
size_t io_ros_begin_image(io_cdr_writer *w, const io_ros_image *image);
size_t io_ros_begin_compressed(io_cdr_writer *w, const io_ros_image *image);
void io_ros_write_camera_info(io_cdr_writer *w, const io_ros_header *header,
                              const rlf_camera *camera);
void io_ros_write_tf(io_cdr_writer *w, const io_ros_transform *transforms, uint32_t count);
void io_ros_write_pose(io_cdr_writer *w, const io_ros_header *header, const rlf_pose *pose);

#endif
