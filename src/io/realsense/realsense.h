/* One RealSense camera that streams. */
#ifndef RLF_IO_REALSENSE_REALSENSE_H
#define RLF_IO_REALSENSE_REALSENSE_H

#include "io/live/driver.h"
#include "io/picture/pixels.h"
#include "relief/base.h"

/* The part of librealsense2's C interface that Relief uses (rs.h 2.56.5; these functions have been
 * there since 2.17 with the same types). */

typedef struct rs2_error rs2_error;
typedef struct rs2_context rs2_context;
typedef struct rs2_device_list rs2_device_list;
typedef struct rs2_device rs2_device;
typedef struct rs2_sensor_list rs2_sensor_list;
typedef struct rs2_sensor rs2_sensor; /* also taken where an rs2_options is wanted */
typedef struct rs2_pipeline rs2_pipeline;
typedef struct rs2_pipeline_profile rs2_pipeline_profile;
typedef struct rs2_config rs2_config;
typedef struct rs2_stream_profile_list rs2_stream_profile_list;
typedef struct rs2_stream_profile rs2_stream_profile;
typedef struct rs2_frame rs2_frame;

/* Values of the library's enumerations. */
enum {
    RS2_INFO_NAME = 0,
    RS2_INFO_SERIAL_NUMBER = 1,
    RS2_STREAM_DEPTH = 1,
    RS2_STREAM_COLOR = 2,
    RS2_FORMAT_ANY = 0,
    RS2_FORMAT_Z16 = 1,
    RS2_FORMAT_YUYV = 4,
    RS2_FORMAT_RGB8 = 5,
    RS2_FORMAT_BGR8 = 6,
    RS2_FORMAT_RGBA8 = 7,
    RS2_FORMAT_BGRA8 = 8,
    RS2_EXTENSION_DEPTH_SENSOR = 7,
    RS2_OPTION_STEREO_BASELINE = 40, /* millimetres */
    RS2_DISTORTION_NONE = 0,
    RS2_DISTORTION_MODIFIED_BROWN_CONRADY = 1,
    RS2_DISTORTION_INVERSE_BROWN_CONRADY = 2,
    RS2_DISTORTION_BROWN_CONRADY = 4
};

typedef struct rs2_intrinsics {
    int width, height;
    float ppx, ppy, fx, fy;
    int model;
    float coeffs[5]; /* k1 k2 p1 p2 k3 */
} rs2_intrinsics;

typedef struct rs2_extrinsics {
    float rotation[9]; /* column by column */
    float translation[3];
} rs2_extrinsics;

/* F(result, name without rs2_, parameters) */
#define IO_REALSENSE_FUNCTIONS(F)                                                                  \
    F(int, get_api_version, (rs2_error **))                                                        \
    F(const char *, get_error_message, (const rs2_error *))                                        \
    F(void, free_error, (rs2_error *))                                                             \
    F(rs2_context *, create_context, (int, rs2_error **))                                          \
    F(void, delete_context, (rs2_context *))                                                       \
    F(rs2_device_list *, query_devices, (const rs2_context *, rs2_error **))                       \
    F(int, get_device_count, (const rs2_device_list *, rs2_error **))                              \
    F(void, delete_device_list, (rs2_device_list *))                                               \
    F(int, device_list_contains, (const rs2_device_list *, const rs2_device *, rs2_error **))      \
    F(rs2_device *, create_device, (const rs2_device_list *, int, rs2_error **))                   \
    F(void, delete_device, (rs2_device *))                                                         \
    F(const char *, get_device_info, (const rs2_device *, int, rs2_error **))                      \
    F(int, supports_device_info, (const rs2_device *, int, rs2_error **))                          \
    F(rs2_sensor_list *, query_sensors, (const rs2_device *, rs2_error **))                        \
    F(int, get_sensors_count, (const rs2_sensor_list *, rs2_error **))                             \
    F(void, delete_sensor_list, (rs2_sensor_list *))                                               \
    F(rs2_sensor *, create_sensor, (const rs2_sensor_list *, int, rs2_error **))                   \
    F(void, delete_sensor, (rs2_sensor *))                                                         \
    F(int, is_sensor_extendable_to, (const rs2_sensor *, int, rs2_error **))                       \
    F(float, get_depth_scale, (rs2_sensor *, rs2_error **))                                        \
    F(int, supports_option, (const rs2_sensor *, int, rs2_error **))                               \
    F(float, get_option, (const rs2_sensor *, int, rs2_error **))                                  \
    F(rs2_pipeline *, create_pipeline, (rs2_context *, rs2_error **))                              \
    F(void, delete_pipeline, (rs2_pipeline *))                                                     \
    F(rs2_pipeline_profile *, pipeline_start_with_config,                                          \
      (rs2_pipeline *, rs2_config *, rs2_error **))                                                \
    F(void, pipeline_stop, (rs2_pipeline *, rs2_error **))                                         \
    F(int, pipeline_try_wait_for_frames,                                                           \
      (rs2_pipeline *, rs2_frame **, unsigned int, rs2_error **))                                  \
    F(rs2_stream_profile_list *, pipeline_profile_get_streams,                                     \
      (rs2_pipeline_profile *, rs2_error **))                                                      \
    F(void, delete_pipeline_profile, (rs2_pipeline_profile *))                                     \
    F(rs2_config *, create_config, (rs2_error **))                                                 \
    F(void, delete_config, (rs2_config *))                                                         \
    F(void, config_enable_device, (rs2_config *, const char *, rs2_error **))                      \
    F(void, config_enable_stream, (rs2_config *, int, int, int, int, int, int, rs2_error **))      \
    F(int, config_can_resolve, (rs2_config *, rs2_pipeline *, rs2_error **))                       \
    F(int, get_stream_profiles_count, (const rs2_stream_profile_list *, rs2_error **))             \
    F(const rs2_stream_profile *, get_stream_profile,                                              \
      (const rs2_stream_profile_list *, int, rs2_error **))                                        \
    F(void, delete_stream_profiles_list, (rs2_stream_profile_list *))                              \
    F(void, get_stream_profile_data,                                                               \
      (const rs2_stream_profile *, int *, int *, int *, int *, int *, rs2_error **))               \
    F(void, get_video_stream_intrinsics,                                                           \
      (const rs2_stream_profile *, rs2_intrinsics *, rs2_error **))                                \
    F(void, get_extrinsics,                                                                        \
      (const rs2_stream_profile *, const rs2_stream_profile *, rs2_extrinsics *, rs2_error **))    \
    F(int, embedded_frames_count, (rs2_frame *, rs2_error **))                                     \
    F(rs2_frame *, extract_frame, (rs2_frame *, int, rs2_error **))                                \
    F(void, release_frame, (rs2_frame *))                                                          \
    F(const rs2_stream_profile *, get_frame_stream_profile, (const rs2_frame *, rs2_error **))     \
    F(unsigned long long, get_frame_number, (const rs2_frame *, rs2_error **))                     \
    F(double, get_frame_timestamp, (const rs2_frame *, rs2_error **)) /* milliseconds */           \
    F(int, get_frame_timestamp_domain, (const rs2_frame *, rs2_error **))                          \
    F(int, get_frame_width, (const rs2_frame *, rs2_error **))                                     \
    F(int, get_frame_height, (const rs2_frame *, rs2_error **))                                    \
    F(int, get_frame_stride_in_bytes, (const rs2_frame *, rs2_error **))                           \
    F(int, get_frame_data_size, (const rs2_frame *, rs2_error **))                                 \
    F(const void *, get_frame_data, (const rs2_frame *, rs2_error **))

/* Not there in every version. */
#define IO_REALSENSE_OPTIONAL_FUNCTIONS(F)                                                         \
    F(void, project_point_to_pixel, (float[2], const rs2_intrinsics *, const float[3]))

typedef struct realsense_api {
#define IO_REALSENSE_MEMBER(result, name, parameters) result(*name) parameters;
    IO_REALSENSE_FUNCTIONS(IO_REALSENSE_MEMBER)
    IO_REALSENSE_OPTIONAL_FUNCTIONS(IO_REALSENSE_MEMBER)
#undef IO_REALSENSE_MEMBER
} realsense_api;

/* When *error is set: sets the error line, frees it and returns `result`; else RLF_OK. */
rlf_result io_realsense_check(const realsense_api *api, rs2_error **error, rlf_result result,
                              const char *source, const char *cure);

/* Frees an error that does not matter; true when there was one. */
bool io_realsense_forget(const realsense_api *api, rs2_error **error);

typedef struct realsense {
    const realsense_api *api;
    char source[256]; /* as the user gave it */
    char name[64], serial[64];
    rs2_context *context;
    rs2_device *device;
    rs2_pipeline *pipeline;
    bool is_streaming;
    rlf_rig rig;
    double units_per_metre;
    int32_t frames_per_second;
    const char *color_encoding; /* of io/pixels/pixels.h; NULL = one that is not read */
    rlf_image_rgba8 color;
    rs2_frame *held; /* the depth picture that was given last; the library's */
    int32_t domain;  /* clock of its time */
    io_live_count count;
    int32_t silent_waits;
} realsense;

/* Starts the streams that are asked for, or the best that the camera has, and reads the rig. */
rlf_result io_realsense_start(realsense *r, const io_mode *depth, const io_mode *color);

/* A rlf_source's `next`. */
rlf_result io_realsense_next(void *self, rlf_frame *out);

/* The library's lens as Relief's. Returns the largest difference, pixels; infinity when Relief has
 * no such lens: the camera is then a pinhole. */
double io_realsense_lens(const realsense_api *api, const rs2_intrinsics *in, rlf_camera *out);

#endif
