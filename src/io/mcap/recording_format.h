/* Names in Relief's own recordings. */
#ifndef RLF_IO_MCAP_RECORDING_FORMAT_H
#define RLF_IO_MCAP_RECORDING_FORMAT_H

#define IO_TOPIC_DEPTH_RVL "/relief/depth/image_raw/compressedDepth"
#define IO_TOPIC_DEPTH_RAW "/relief/depth/image_raw"
#define IO_TOPIC_DEPTH_INFO "/relief/depth/camera_info"
#define IO_TOPIC_COLOR "/relief/color/image_raw/compressed"
#define IO_TOPIC_COLOR_INFO "/relief/color/camera_info"
#define IO_TOPIC_POSE "/relief/pose"

#define IO_TOPIC_FRAME "/relief/frame"

#define IO_FRAME_DEPTH "relief_depth_optical_frame"
#define IO_FRAME_COLOR "relief_color_optical_frame"
#define IO_FRAME_WORLD "relief_world"

/* Keys of the Metadata record "relief": what ROS 2 has no message for. */
#define IO_KEY_UNITS "units_per_metre"
#define IO_KEY_DEPTH_MIN "depth_min_m"
#define IO_KEY_DEPTH_MAX "depth_max_m"
#define IO_KEY_NOISE_0 "noise_c0"
#define IO_KEY_NOISE_1 "noise_c1"
#define IO_KEY_NOISE_2 "noise_c2"
#define IO_KEY_FLAGS "frame_flags"
#define IO_KEY_SOURCE "source"
#define IO_KEY_DEVICE "device"
#define IO_KEY_GRAVITY "gravity_m_s2" /* "X Y Z" */
#define IO_KEY_SIMULATED "is_simulated"
#define IO_KEY_RATE "frames_per_second"
#define IO_KEY_NOTES "frame_notes" /* there are: what is not noted of a frame is as usual */
#define IO_KEY_UNIX_OFFSET "unix_minus_stamp_ns"

#endif
