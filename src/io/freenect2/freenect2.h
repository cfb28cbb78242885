/* One Kinect v2 that streams. */
#ifndef RLF_IO_FREENECT2_FREENECT2_H
#define RLF_IO_FREENECT2_FREENECT2_H

#include "io/driver/live.h"
#include "io/freenect2/freenect2_shim.h"
#include "io/freenect2/kinect2_rig.h"

typedef struct freenect2_api {
#define IO_FREENECT2_MEMBER(result, name, parameters) result(*name) parameters;
    RELIEF_FREENECT2_FUNCTIONS(IO_FREENECT2_MEMBER)
#undef IO_FREENECT2_MEMBER
} freenect2_api;

typedef struct freenect2 {
    const freenect2_api *api;
    char source[256];
    relief_freenect2 *device;
    kinect2_ir ir;
    kinect2_color factory;
    rlf_rig rig;
    float *depth; /* metres, not mirrored */
    rlf_image_rgba8 color;
    bool is_aligned; /* the next four are for this alone */
    kinect2_registration *registration;
    float *undistorted;
    uint32_t *registered;
    int32_t *offset;
    io_live_count count;
    bool has_time;
    uint32_t time_last; /* the device's, of the last depth picture */
    int64_t time_ns;    /* alike, without wrapping */
    int64_t last_frame_ns;
    uint64_t unpaired;
} freenect2;

/* A rlf_source's `next`. */
rlf_result io_freenect2_next(void *self, rlf_frame *out);

#endif
