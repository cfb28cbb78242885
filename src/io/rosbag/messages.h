/* The messages of ROS 1 that hold pictures and calibrations. */
#ifndef RLF_IO_ROSBAG_MESSAGES_H
#define RLF_IO_ROSBAG_MESSAGES_H

#include "io/file.h"
#include "io/pixels/pixels.h"
#include "io/ros/camera_info.h"

typedef enum message_kind {
    MESSAGE_OTHER,
    MESSAGE_IMAGE,
    MESSAGE_COMPRESSED_IMAGE,
    MESSAGE_CAMERA_INFO,
    MESSAGE_TF,        /* tf2_msgs/TFMessage and tf/tfMessage */
    MESSAGE_TRANSFORM, /* of a RealSense stream */
    MESSAGE_FLOAT,     /* of a RealSense option */
    MESSAGE_KEY_VALUE  /* of a RealSense device */
} message_kind;

message_kind message_kind_of(const char *type);

/* sensor_msgs/Image or CompressedImage; points into the message. */
typedef struct message_image {
    int64_t time_ns; /* of its header */
    char frame_id[IO_ROS_NAME_MAX];
    char encoding[64]; /* or the compressed one's format */
    bool is_compressed;
    io_pixels pixels;       /* of an Image */
    io_bytes file;          /* of a CompressedImage */
    double units_per_metre; /* RealSense 2.50 and later say them; 0 = not said */
} message_image;

/* RLF_ERROR_FORMAT when it is cut short. pixels.encoding points into *out. */
rlf_result message_read_image(const io_bytes *message, message_kind kind, message_image *out);

/* Only the time of a message with a header. False when it is cut short. */
bool message_read_time(const io_bytes *message, int64_t *out_ns);

/* sensor_msgs/CameraInfo. False when it is cut short. */
bool message_read_info(const io_bytes *message, io_camera_info *out);

/* geometry_msgs/Transform: p_out = T p_in. False when it is no transform. */
bool message_read_transform(const io_bytes *message, rlf_pose *out);

bool message_read_float(const io_bytes *message, double *out);

/* Whether the message is the key's value; copies it. */
bool message_read_value(const io_bytes *message, const char *key, char *out, size_t capacity);

#endif
