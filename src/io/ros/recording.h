/* Recordings of ROS 1 and 2 as sources: all but the files that they are in. */
#ifndef RLF_IO_ROS_RECORDING_H
#define RLF_IO_ROS_RECORDING_H

#include "io/clip/clip.h"
#include "io/file.h"
#include "io/picture/pixels.h"
#include "io/ros/log.h"
#include "relief/image.h"

/* ---- Pictures in ROS messages: what they are, and their pixels ---- */

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

/* Which topics of a ROS recording are the depth and the colour pictures, and their calibration: the
 * same for ROS 1 and 2. */

typedef enum io_ros_picture {
    IO_ROS_PICTURE_NONE = 0, /* cannot be read */
    IO_ROS_PICTURE_DEPTH,
    IO_ROS_PICTURE_COLOR,
    IO_ROS_PICTURE_GREY
} io_ros_picture;

/* A topic of pictures, as its first readable one has it. */
typedef struct io_ros_topic {
    const char *name;  /* the caller's */
    char encoding[64]; /* of an Image, or the format of a CompressedImage */
    char frame_id[IO_ROS_NAME_MAX];
    io_ros_picture kind;
    int32_t width, height; /* 0 = not known */
    int32_t count;         /* pictures */
} io_ros_topic;

/* A topic of calibrations, and its first message. */
typedef struct io_ros_info_topic {
    const char *name;
    io_camera_info info;
} io_ros_info_topic;

/* What a recording holds. Lists of the caller. */
typedef struct io_ros_topics {
    const char *name; /* of the file, for error lines */
    bool is_live;
    const io_ros_topic *pictures;
    const io_ros_info_topic *infos;
    int32_t picture_count, info_count;
    const char *strangers; /* topics of pictures in messages that are not read; "" = none */
    /* Whether the file's transforms lead from one frame to the other. */
    bool (*is_joined)(void *self, const char *from, const char *to);
    void *self;
} io_ros_topics;

/* Indexes into the pictures; *out_color -1 = none. A name given decides; NULL = not given, "none" =
 * no colour. When the depth camera's own pictures cannot be laid on the colour, for want of a
 * transform, and the file holds depth as the colour camera sees it, that is taken. More than one
 * topic of depth is told. Fails when there is no depth, or not what was named. */
rlf_result io_ros_choose(const io_ros_topics *topics, const char *depth, const char *color,
                         int32_t *out_depth, int32_t *out_color);

/* How many parts of the path two topics begin with alike. */
int32_t io_ros_common_parts(const char *a, const char *b);

/* Index into infos of the calibration of a topic: the one beside it, else one of its frame_id, else
 * one of its size, which is told. -1 = none that describes pictures of its size. */
int32_t io_ros_find_info(const io_ros_topics *topics, const io_ros_topic *picture);

/* Whether there is one beside it or of its frame_id. */
bool io_ros_has_info(const io_ros_topics *topics, const io_ros_topic *picture);

/* What is known of the calibration beside a topic, for a line that tells why it is not taken. */
const char *io_ros_tell_info(const io_ros_topics *topics, const io_ros_topic *picture, char *out,
                             size_t size);

/* A topic of pictures, and when they were taken. */
typedef struct io_ros_stream {
    int32_t channel, picture; /* -1 = none */
    bool is_compressed;
    io_ros_pixels pixels;
    io_shots shots; /* by time; their places are numbers in the topic */
} io_ros_stream;

typedef struct io_ros_transforms io_ros_transforms;

/* Zero it, and set the log. */
typedef struct io_ros_recording {
    io_ros_log log;
    io_ros_topics lists;
    io_ros_stream *streams; /* of the pictures, in their order */
    io_ros_topic *pictures;
    io_ros_info_topic *infos;
    io_ros_transforms *transforms;
    io_ros_stream depth, color; /* what was chosen */
    rlf_rig rig;
    bool has_given_rig; /* from a file */
    double units_per_metre;
    uint32_t flags;
    io_ros_decoder decoder;
} io_ros_recording;

/* Looks at the topics, chooses depth and colour, and finds their calibration. */
rlf_result io_ros_prepare(io_ros_recording *r, const rlf_address *address);
/* Lists their pictures, by the messages' own times when they have any. */
rlf_result io_ros_list_pictures(io_ros_recording *r, bool has_stamps);
/* The def has poses, origin, destroy and self; the rest is filled in. */
rlf_result io_ros_open_clip(io_ros_recording *r, const rlf_address *address, io_clip_def *def,
                            rlf_opened *out);
/* With the lists of its log, but not what that reads from. */
void io_ros_recording_free(io_ros_recording *r);

/* Picture `index` of a topic. */
rlf_result io_ros_read_picture(const io_ros_log *log, const io_ros_stream *stream, int32_t index,
                               io_ros_image *out);

/* ---- steps of io_ros_prepare ----------------------------------------------------------------- */

rlf_result io_ros_list_topics(io_ros_recording *r);
rlf_result io_ros_read_rig(io_ros_recording *r, const rlf_address *address);

/* Of ROS 2 from /tf_static alone. rlf_free it. */
rlf_result io_ros_transforms_read(const io_ros_log *log, io_ros_transforms **out);
/* False when the two frames are not joined. */
bool io_ros_transforms_find(const io_ros_transforms *t, const char *from, const char *to,
                            rlf_pose *out_T_to_from);

#endif
