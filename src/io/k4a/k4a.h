/* One Azure Kinect or Femto camera that streams. */
#ifndef RLF_IO_K4A_K4A_H
#define RLF_IO_K4A_K4A_H

#include "io/live/driver.h"
#include "relief/base.h"

/* The part of the Azure Kinect SDK's C interface that Relief uses (k4a.h and k4atypes.h 1.4.1). */

typedef struct k4a_device *k4a_device_t;
typedef struct k4a_capture *k4a_capture_t;
typedef struct k4a_image *k4a_image_t;

/* Values of the library's enumerations. */
enum {
    K4A_SUCCEEDED = 0, /* of every result type */
    K4A_WAIT_TIMEOUT = 2,
    K4A_DEPTH_MODE_NFOV_2X2BINNED = 1,
    K4A_DEPTH_MODE_NFOV_UNBINNED = 2,
    K4A_DEPTH_MODE_WFOV_2X2BINNED = 3,
    K4A_DEPTH_MODE_WFOV_UNBINNED = 4,
    K4A_COLOR_RESOLUTION_720P = 1,
    K4A_COLOR_RESOLUTION_1080P = 2,
    K4A_COLOR_RESOLUTION_1440P = 3,
    K4A_COLOR_RESOLUTION_1536P = 4,
    K4A_COLOR_RESOLUTION_2160P = 5,
    K4A_COLOR_RESOLUTION_3072P = 6,
    K4A_FORMAT_COLOR_MJPG = 0,
    K4A_FORMAT_COLOR_YUY2 = 2,
    K4A_FORMAT_COLOR_BGRA32 = 3,
    K4A_FPS_5 = 0,
    K4A_FPS_15 = 1,
    K4A_FPS_30 = 2,
    K4A_LENS_RATIONAL_6KT = 3, /* of early internal devices */
    K4A_LENS_BROWN_CONRADY = 4,
    K4A_CAMERA_DEPTH = 0,
    K4A_CAMERA_COLOR = 1
};

typedef struct k4a_configuration {
    int color_format, color_resolution, depth_mode, camera_fps;
    bool synchronized_images_only;
    int32_t depth_delay_off_color_usec;
    int wired_sync_mode;
    uint32_t subordinate_delay_off_master_usec;
    bool disable_streaming_indicator;
} k4a_configuration;

typedef struct k4a_extrinsics {
    float rotation[9];    /* row by row */
    float translation[3]; /* millimetres */
} k4a_extrinsics;

/* What the library keeps as parameters, in its order. */
typedef struct k4a_lens {
    float cx, cy, fx, fy, k1, k2, k3, k4, k5, k6, codx, cody, p2, p1, metric_radius;
} k4a_lens;

typedef struct k4a_camera {
    k4a_extrinsics extrinsics;
    int type;
    unsigned int parameter_count;
    k4a_lens lens;
    int width, height;
    float metric_radius;
} k4a_camera;

typedef struct k4a_calibration {
    k4a_camera depth, color;
    k4a_extrinsics extrinsics[4][4]; /* [from][to] of depth, colour, gyroscope, accelerometer */
    int depth_mode, color_resolution;
} k4a_calibration;

/* F(result, name without k4a_, parameters) */
#define IO_K4A_FUNCTIONS(F)                                                                        \
    F(uint32_t, device_get_installed_count, (void))                                                \
    F(int, device_open, (uint32_t, k4a_device_t *))                                                \
    F(void, device_close, (k4a_device_t))                                                          \
    F(int, device_get_serialnum, (k4a_device_t, char *, size_t *))                                 \
    F(int, device_start_cameras, (k4a_device_t, const k4a_configuration *))                        \
    F(void, device_stop_cameras, (k4a_device_t))                                                   \
    F(int, device_get_calibration, (k4a_device_t, int, int, k4a_calibration *))                    \
    F(int, device_get_capture, (k4a_device_t, k4a_capture_t *, int32_t))                           \
    F(void, capture_release, (k4a_capture_t))                                                      \
    F(k4a_image_t, capture_get_color_image, (k4a_capture_t))                                       \
    F(k4a_image_t, capture_get_depth_image, (k4a_capture_t))                                       \
    F(void, image_release, (k4a_image_t))                                                          \
    F(uint8_t *, image_get_buffer, (k4a_image_t))                                                  \
    F(size_t, image_get_size, (k4a_image_t))                                                       \
    F(int, image_get_format, (k4a_image_t))                                                        \
    F(int, image_get_width_pixels, (k4a_image_t))                                                  \
    F(int, image_get_height_pixels, (k4a_image_t))                                                 \
    F(int, image_get_stride_bytes, (k4a_image_t))                                                  \
    F(uint64_t, image_get_device_timestamp_usec, (k4a_image_t))

typedef struct k4a_api {
#define IO_K4A_MEMBER(result, name, parameters) result(*name) parameters;
    IO_K4A_FUNCTIONS(IO_K4A_MEMBER)
#undef IO_K4A_MEMBER
} k4a_api;

typedef struct k4a {
    const k4a_api *api;
    char source[256], serial[64];
    k4a_device_t device;
    bool is_streaming;
    rlf_rig rig;
    k4a_configuration configuration;
    int32_t frames_per_second;
    rlf_image_rgba8 color;
    k4a_image_t held; /* the depth picture that was given last; the library's */
    io_live_count count;
} k4a;

/* Modes of the camera that are asked for; the defaults where 0. */
rlf_result io_k4a_configure(k4a *k, const io_mode *depth, const io_mode *color);

/* Reads the rig of the configured modes. */
rlf_result io_k4a_read_rig(k4a *k);

/* A rlf_source's `next`. */
rlf_result io_k4a_next(void *self, rlf_frame *out);

#endif
