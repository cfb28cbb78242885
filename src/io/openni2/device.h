/* An OpenNI2 device with its depth and colour streams. */
#ifndef RLF_IO_OPENNI2_DEVICE_H
#define RLF_IO_OPENNI2_DEVICE_H

#include "io/openni2/api.h"
#include "relief/backend.h"

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
