/* Kinect v1 through libfreenect. */
#ifndef RLF_IO_FREENECT_FREENECT_H
#define RLF_IO_FREENECT_FREENECT_H

#include "relief/base.h"
#include "relief/frame.h"

#include <sys/time.h>

/* The functions of libfreenect that we call, found at run time in libfreenect.so.0.5. */

#define FREENECT_WIDTH 640
#define FREENECT_HEIGHT 480
#define FREENECT_RAW_COUNT 2048 /* of 11 bits */
#define FREENECT_RAW_MISSING 2047
#define FREENECT_MM_COUNT 10000 /* entries of depth_to_rgb_shift */
#define FREENECT_TABLE_SCALE 256.0

enum { FREENECT_MEDIUM = 1 };                          /* resolution: 640 x 480 */
enum { FREENECT_CAMERA = 2 };                          /* subdevice */
enum { FREENECT_RAW_11 = 0, FREENECT_REGISTERED = 4 }; /* depth formats */
enum { FREENECT_RGB = 0 };                             /* video format */

/* Layouts of libfreenect 0.5. */
typedef struct freenect_mode {
    uint32_t reserved;
    int32_t resolution, format, size;
    int16_t width, height;
    int8_t bits, padding_bits, rate, is_valid;
} freenect_mode;

typedef struct freenect_attributes {
    struct freenect_attributes *next;
    const char *serial;
} freenect_attributes;

/* What the factory measured. */
typedef struct freenect_registration {
    int32_t polynomial[29];
    uint16_t padding[3];
    float emitter_cm;   /* from the infrared camera to the projector */
    float color_cm;     /* from the infrared camera to the colour camera */
    float reference_cm; /* distance of the reference plane */
    float pixel_mm;     /* of the sensor, 1280 wide, on the reference plane */
    double const_shift;
    uint16_t *raw_to_mm;
    int32_t *depth_to_rgb_shift; /* by millimetre: 1/256 colour pixel */
    int32_t (
        *table)[2]; /* by depth pixel: x in 1/256 colour pixel without the shift, y in pixels */
} freenect_registration;

typedef void (*freenect_picture_fn)(void *device, void *picture, uint32_t time);
typedef void (*freenect_log_fn)(void *context, int level, const char *line);

/* F(result, member, name without freenect_, parameters) */
#define FREENECT_FUNCTIONS(F)                                                                      \
    F(int, init, "init", (void **out_context, void *usb))                                          \
    F(int, shutdown, "shutdown", (void *context))                                                  \
    F(void, set_log, "set_log_callback", (void *context, freenect_log_fn fn))                      \
    F(void, select_subdevices, "select_subdevices", (void *context, int flags))                    \
    F(int, count_devices, "num_devices", (void *context))                                          \
    F(int, open, "open_device", (void *context, void **out_device, int index))                     \
    F(int, open_serial, "open_device_by_camera_serial",                                            \
      (void *context, void **out_device, const char *serial))                                      \
    F(int, close, "close_device", (void *device))                                                  \
    F(void, set_user, "set_user", (void *device, void *user))                                      \
    F(void *, get_user, "get_user", (void *device))                                                \
    F(void, on_depth, "set_depth_callback", (void *device, freenect_picture_fn fn))                \
    F(void, on_video, "set_video_callback", (void *device, freenect_picture_fn fn))                \
    F(freenect_mode, find_depth, "find_depth_mode", (int resolution, int format))                  \
    F(freenect_mode, find_video, "find_video_mode", (int resolution, int format))                  \
    F(int, set_depth, "set_depth_mode", (void *device, freenect_mode mode))                        \
    F(int, set_video, "set_video_mode", (void *device, freenect_mode mode))                        \
    F(int, start_depth, "start_depth", (void *device))                                             \
    F(int, start_video, "start_video", (void *device))                                             \
    F(int, stop_depth, "stop_depth", (void *device))                                               \
    F(int, stop_video, "stop_video", (void *device))                                               \
    F(int, process, "process_events_timeout", (void *context, struct timeval *timeout))

/* These may be NULL: Debian's fakenect has none of them. */
#define FREENECT_OPTIONAL_FUNCTIONS(F)                                                             \
    F(int, list_attributes, "list_device_attributes", (void *context, freenect_attributes **out))  \
    F(void, free_attributes, "free_device_attributes", (freenect_attributes * list))               \
    F(freenect_registration, copy_registration, "copy_registration", (void *device))               \
    F(int, destroy_registration, "destroy_registration", (freenect_registration * registration))

typedef struct freenect_api {
#define FREENECT_MEMBER(result, member, name, parameters) result(*member) parameters;
    FREENECT_FUNCTIONS(FREENECT_MEMBER) FREENECT_OPTIONAL_FUNCTIONS(FREENECT_MEMBER)
#undef FREENECT_MEMBER
} freenect_api;

/* Kinect v1: from the sensor's counts to depth, and how its two cameras stand. */

#define FREENECT_UNITS_PER_METRE 1000.0

/* Depth in millimetres of each raw count, rounded; 0 = missing. `registration` NULL = the values of
 * a typical device. */
void freenect_depth_table(const freenect_registration *registration,
                          uint16_t out[FREENECT_RAW_COUNT]);

/* The depth camera, the colour camera and the transform between them. Factory tables, where they
 * are, are fitted by a turn round the optical axis, a shift, and the colour camera's lens:
 * *out_error is the largest distance in colour pixels from what the tables say; -1 = no tables. */
void freenect_make_rig(const freenect_registration *registration, rlf_rig *out, double *out_error);

#endif
