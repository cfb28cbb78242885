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

/* Functions from list_attributes on may be NULL: Debian's fakenect has none of them. */
typedef struct freenect_api {
    int (*init)(void **out_context, void *usb);
    int (*shutdown)(void *context);
    void (*set_log)(void *context, freenect_log_fn fn);
    void (*select_subdevices)(void *context, int flags);
    int (*count_devices)(void *context);
    int (*open)(void *context, void **out_device, int index);
    int (*open_serial)(void *context, void **out_device, const char *serial);
    int (*close)(void *device);
    void (*set_user)(void *device, void *user);
    void *(*get_user)(void *device);
    void (*on_depth)(void *device, freenect_picture_fn fn);
    void (*on_video)(void *device, freenect_picture_fn fn);
    freenect_mode (*find_depth)(int resolution, int format);
    freenect_mode (*find_video)(int resolution, int format);
    int (*set_depth)(void *device, freenect_mode mode);
    int (*set_video)(void *device, freenect_mode mode);
    int (*start_depth)(void *device);
    int (*start_video)(void *device);
    int (*stop_depth)(void *device);
    int (*stop_video)(void *device);
    int (*process)(void *context, struct timeval *timeout);
    int (*list_attributes)(void *context, freenect_attributes **out);
    void (*free_attributes)(freenect_attributes *list);
    freenect_registration (*copy_registration)(void *device);
    int (*destroy_registration)(freenect_registration *registration);
} freenect_api;

/* Why the library cannot be used and what to do, or NULL when it can. */
const char *freenect_unavailable(void);
/* NULL when it cannot be used. Thread-safety: safe. */
const freenect_api *freenect_get_api(void);

/* Kinect v1: from the sensor's counts to depth, and how its two cameras stand. */

#define FREENECT_UNITS_PER_METRE 1000.0

/* Whether the device told its reference plane. */
bool freenect_has_reference(const freenect_registration *registration);

/* Depth in millimetres of each raw count, rounded; 0 = missing. `registration` NULL = the values of
 * a typical device. */
void freenect_depth_table(const freenect_registration *registration,
                          uint16_t out[FREENECT_RAW_COUNT]);

/* The depth camera, the colour camera and the transform between them. Factory tables, where they
 * are, are fitted by a turn round the optical axis, a shift, and the colour camera's lens:
 * *out_error is the largest distance in colour pixels from what the tables say; -1 = no tables. */
void freenect_make_rig(const freenect_registration *registration, rlf_rig *out, double *out_error);

#endif
