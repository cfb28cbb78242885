/* Which topics of a ROS recording are the depth and the colour pictures, and their calibration: the
 * same for ROS 1 and 2. */
#ifndef RLF_IO_ROS_TOPICS_H
#define RLF_IO_ROS_TOPICS_H

#include "io/ros/camera_info.h"

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

/* Whether messages of a type are pictures or depth in a form that is not read. */
bool io_ros_is_stranger(const char *type);
/* Adds "TOPIC (TYPE, ENCODING)" to the texts of strangers, once. `encoding` may be "". */
void io_ros_add_stranger(char *out, size_t size, const char *topic, const char *type,
                         const char *encoding);

/* Index into infos of the calibration of a topic: the one beside it, else one of its frame_id, else
 * one of its size, which is told. -1 = none that describes pictures of its size. */
int32_t io_ros_find_info(const io_ros_topics *topics, const io_ros_topic *picture);

/* Whether there is one beside it or of its frame_id. */
bool io_ros_has_info(const io_ros_topics *topics, const io_ros_topic *picture);

/* What is known of the calibration beside a topic, for a line that tells why it is not taken. */
const char *io_ros_tell_info(const io_ros_topics *topics, const io_ros_topic *picture, char *out,
                             size_t size);

#endif
