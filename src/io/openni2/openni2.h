/* Cameras through OpenNI2. */
#ifndef RLF_IO_OPENNI2_OPENNI2_H
#define RLF_IO_OPENNI2_OPENNI2_H

#include "relief/backend.h"
#include "relief/base.h"

/* The functions of OpenNI2 that we call, found at run time in libOpenNI2.so.0. */

/* Layouts and numbers of OpenNI 2.2's C interface. Its own header is no C. */

enum { OPENNI2_OK = 0, OPENNI2_TIME_OUT = 102 };
enum { OPENNI2_COLOR = 2, OPENNI2_DEPTH = 3 }; /* sensor types */
enum { OPENNI2_DEPTH_1_MM = 100, OPENNI2_DEPTH_100_UM = 101, OPENNI2_RGB888 = 200 };
enum { OPENNI2_STATE_ERROR = 1 };

enum {
    OPENNI2_DEVICE_SERIAL = 3,
    OPENNI2_DEVICE_REGISTRATION = 5 /* int: 1 = depth warped into the colour camera */
};
enum {
    OPENNI2_STREAM_FOV_X = 1, /* float, radians */
    OPENNI2_STREAM_FOV_Y = 2,
    OPENNI2_STREAM_MODE = 3,
    OPENNI2_STREAM_MAX = 4,   /* int, largest depth */
    OPENNI2_STREAM_MIRROR = 7 /* int */
};

#define OPENNI2_TEXT_MAX 256
#define OPENNI2_VERSION 2002 /* 2.2 */

typedef struct openni2_mode {
    int format, width, height, fps;
} openni2_mode;

typedef struct openni2_sensor {
    int type, mode_count;
    openni2_mode *modes;
} openni2_sensor;

typedef struct openni2_info {
    char uri[OPENNI2_TEXT_MAX], vendor[OPENNI2_TEXT_MAX], name[OPENNI2_TEXT_MAX];
    uint16_t usb_vendor, usb_product;
} openni2_info;

typedef struct openni2_frame {
    int data_size; /* bytes */
    void *data;
    int sensor;
    uint64_t time_us;
    int index;
    int width, height;
    openni2_mode mode;
    int is_cropped, crop_x, crop_y;
    int stride; /* bytes */
} openni2_frame;

typedef struct openni2_callbacks {
    void (*connected)(const openni2_info *info, void *cookie);
    void (*disconnected)(const openni2_info *info, void *cookie);
    void (*state_changed)(const openni2_info *info, int state, void *cookie);
} openni2_callbacks;

/* F(result, member, name without oni, parameters). Each returns OPENNI2_OK or an error. Devices and
 * streams are handles of the library's. */
#define OPENNI2_FUNCTIONS(F)                                                                       \
    F(int, initialize, "Initialize", (int version))                                                \
    F(void, shutdown, "Shutdown", (void))                                                          \
    F(const char *, error, "GetExtendedError", (void))                                             \
    F(int, get_devices, "GetDeviceList", (openni2_info * *out, int *out_count))                    \
    F(int, release_devices, "ReleaseDeviceList", (openni2_info * devices))                         \
    F(int, add_callbacks, "RegisterDeviceCallbacks",                                               \
      (openni2_callbacks * callbacks, void *cookie, void **out_handle))                            \
    F(void, remove_callbacks, "UnregisterDeviceCallbacks", (void *handle))                         \
    F(int, wait_any, "WaitForAnyStream",                                                           \
      (void **streams, int count, int *out_index, int timeout_ms))                                 \
    F(int, device_open, "DeviceOpen", (const char *uri, void **out_device))                        \
    F(int, device_close, "DeviceClose", (void *device))                                            \
    F(int, device_info, "DeviceGetInfo", (void *device, openni2_info *out))                        \
    F(const openni2_sensor *, device_sensor, "DeviceGetSensorInfo", (void *device, int type))      \
    F(int, device_stream, "DeviceCreateStream", (void *device, int type, void **out_stream))       \
    F(int, device_set, "DeviceSetProperty",                                                        \
      (void *device, int property, const void *data, int size))                                    \
    F(int, device_get, "DeviceGetProperty", (void *device, int property, void *data, int *size))   \
    F(int, device_can_register, "DeviceIsImageRegistrationModeSupported",                          \
      (void *device, int mode))                                                                    \
    F(void, stream_destroy, "StreamDestroy", (void *stream))                                       \
    F(int, stream_start, "StreamStart", (void *stream))                                            \
    F(void, stream_stop, "StreamStop", (void *stream))                                             \
    F(int, stream_read, "StreamReadFrame", (void *stream, openni2_frame **out))                    \
    F(int, stream_set, "StreamSetProperty",                                                        \
      (void *stream, int property, const void *data, int size))                                    \
    F(int, stream_get, "StreamGetProperty", (void *stream, int property, void *data, int *size))   \
    F(void, frame_release, "FrameRelease", (openni2_frame * frame))

typedef struct openni2_api {
#define OPENNI2_MEMBER(result, member, name, parameters) result(*member) parameters;
    OPENNI2_FUNCTIONS(OPENNI2_MEMBER)
#undef OPENNI2_MEMBER
} openni2_api;

/* Loads the library and looks for devices. Error lines start with `who`; on failure *out is left
 * alone. Each call that succeeds needs one of openni2_end. Thread-safety: safe. */
rlf_result openni2_begin(const char *who, const openni2_api **out);
void openni2_end(void);

/* ---- An OpenNI2 device with its depth and colour streams ---- */

/* What the keys of an address ask for. */
typedef struct openni2_wish {
    int width, height, fps;        /* of depth; 0 = any; fps of both streams */
    int color_width, color_height; /* 0 = any */
    int color;                     /* 0 = without */
    int aligned;                   /* -1 = as the device can */
    int mirror;                    /* pictures come mirrored: 0, 1, or -1 = as the device says */
} openni2_wish;

typedef struct openni2_stream {
    void *handle; /* NULL = there is none */
    openni2_mode mode;
    bool flips; /* its pictures come mirrored */
} openni2_stream;

typedef struct openni2_device {
    const openni2_api *api;
    void *handle;
    openni2_info info;
    char serial[OPENNI2_TEXT_MAX];
    openni2_stream depth, color;
    bool can_align;
    bool is_aligned; /* depth is warped into the colour camera */
} openni2_device;

/* Reads the keys mode, color, aligned, mirror. */
rlf_result openni2_read_wish(const rlf_address *address, openni2_wish *out);

/* Opens a device by URI or serial number ("" = the first one) and its streams; they are not
 * started. Close it even when this fails. */
rlf_result openni2_device_open(const rlf_address *address, const openni2_wish *wish,
                               openni2_device *device);
rlf_result openni2_device_start(const rlf_address *address, openni2_device *device);
/* A device that is zero but for `api` is allowed. */
void openni2_device_close(openni2_device *device);

/* A number that the stream tells, or `otherwise`. */
int openni2_stream_int(const openni2_device *device, const openni2_stream *stream, int property,
                       int otherwise);
float openni2_stream_float(const openni2_device *device, const openni2_stream *stream, int property,
                           float otherwise);

/* Test devices of the library are listed only when they are the place asked for. */
bool openni2_is_test_device(const openni2_info *info);

/* Cameras of the open streams: from the fields of view, or the user's calibration. */
rlf_result openni2_make_rig(const rlf_address *address, const openni2_device *device, rlf_rig *out);
/* Counts per metre of the depth stream. */
double openni2_units(const openni2_device *device);

#endif
