/* One RealSense camera that streams. */
#ifndef RLF_IO_REALSENSE_REALSENSE_H
#define RLF_IO_REALSENSE_REALSENSE_H

#include "io/driver/live.h"
#include "io/pixels/pixels.h"
#include "io/realsense/realsense_api.h"

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
    uint64_t damaged, unpaired;
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
