/* Recordings of ROS 1 and 2 as sources: all but the files that they are in. */
#ifndef RLF_IO_ROS_RECORDING_H
#define RLF_IO_ROS_RECORDING_H

#include "io/clip/clip.h"
#include "io/ros/pixels.h"
#include "io/ros/topics.h"

/* A topic in the file. Its messages are first .. first + count - 1, in the order of their times. */
typedef struct io_ros_channel {
    const char *topic;
    io_ros_type type;
    int32_t first, count;
} io_ros_channel;

/* A file of messages. */
typedef struct io_ros_log {
    const char *name; /* for error lines; stays while the log does */
    bool is_ros1;
    bool has_own_poses;    /* the driver's; tf is not asked */
    const char *strangers; /* as in io_ros_topics */
    int32_t channel_count;
    void *self;
    io_ros_channel (*channel)(void *self, int32_t index);
    int64_t (*time)(void *self, int32_t message);
    /* The message's bytes stay valid until the next call. */
    rlf_result (*read)(void *self, int32_t message, io_cdr_reader *out);
} io_ros_log;

typedef struct io_ros_shot io_ros_shot;

/* A topic of pictures, and when they were taken. */
typedef struct io_ros_stream {
    int32_t channel, picture; /* -1 = none */
    bool is_compressed;
    io_ros_pixels pixels;
    io_ros_shot *shots; /* in the order of `times` */
    int64_t *times;
    int32_t count;
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
/* All but the log. */
void io_ros_recording_free(io_ros_recording *r);

/* Picture `index` of a topic. */
rlf_result io_ros_read_picture(const io_ros_log *log, const io_ros_stream *stream, int32_t index,
                               io_ros_image *out);

/* ---- steps of io_ros_prepare ---------------------------------------------------------------- */

rlf_result io_ros_list_topics(io_ros_recording *r);
rlf_result io_ros_read_rig(io_ros_recording *r, const rlf_address *address);

/* Of ROS 2 from /tf_static alone. rlf_free it. */
rlf_result io_ros_transforms_read(const io_ros_log *log, io_ros_transforms **out);
/* False when the two frames are not joined. */
bool io_ros_transforms_find(const io_ros_transforms *t, const char *from, const char *to,
                            rlf_pose *out_T_to_from);

#endif
