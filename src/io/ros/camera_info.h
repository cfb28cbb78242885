/* sensor_msgs/CameraInfo of ROS 1 and 2: what it says of a lens. */
#ifndef RLF_IO_ROS_CAMERA_INFO_H
#define RLF_IO_ROS_CAMERA_INFO_H

#include "io/camera_window.h"

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

/* The camera of these pictures. Of a topic whose name says "rect" that is P, free of distortion;
 * else K and D. A warning tells what of the lens cannot be used. RLF_ERROR_FORMAT when it is not
 * calibrated or describes no picture. `name`: the file, for these lines. */
rlf_result io_camera_info_lens(const io_camera_info *info, const char *name, const char *topic,
                               rlf_camera *out);

#endif
