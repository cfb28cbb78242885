/* Relief: one picture from a depth camera, the value that flows from capture to surface.
 *
 * A frame is complete when published and never changes afterwards.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_FRAME_H
#define RELIEF_FRAME_H

#include "relief/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Standard deviation of depth along z: sigma(z) = c0 + c1 z + c2 z^2, metres, z in metres, of one
 * pixel from frame to frame on a still surface. Tolerances everywhere are multiples of it.
 * Defaults: Kinect v2 after Fankhauser et al. 2015 (frontal surfaces); `relief-lab measure --noise`
 * fits it to a camera of your own. */
typedef struct rlf_depth_noise {
    double c0, c1, c2; /* metres, 1, 1/metre */
} rlf_depth_noise;

/* sigma at depth z, metres; never below 0.3 mm, which is less than any sensor's step, so that
 * nothing is divided by nothing. */
static inline double rlf_depth_noise_sigma(const rlf_depth_noise *noise, double z)
{
    return RLF_ASSERT(noise != NULL) ? rlf_max(noise->c0 + z * (noise->c1 + z * noise->c2), 0.0003)
                                     : 0.0;
}

/* The cameras of a sensor, fixed for a source's life: stages size their planes by it once. */
typedef struct rlf_rig {
    rlf_camera depth;       /* intrinsics, lens and size of the depth pictures */
    rlf_camera color;       /* used when has_color; size of the colour frames */
    rlf_pose T_color_depth; /* p_color = T p_depth; identity when depth is already aligned */
    bool has_color;         /* false: no frame has colour */
    double depth_min_m;     /* nearest depth the sensor reports, metres (Kinect v2: 0.5) */
    double depth_max_m;    /* farthest (Kinect v2: 4.5); libraries keep what is beyond as missing */
    rlf_depth_noise noise; /* of the raw depth */
    double depth_offset_m; /* the sensor measures too far by this, metres: rlf_source_next and
                              rlf_source_observe give depth from which it is taken away */
} rlf_rig;

/* What is taken of a camera of which no more is known: 0.1 to 8 m, a structured-light sensor's
 * noise, no colour. `depth` is zero: set it, and whatever else is known better. */
RLF_API rlf_rig rlf_rig_default(void);

/* What a source says about a frame, bits of rlf_frame.flags. */
typedef enum rlf_frame_flag {
    /* The driver gave mirrored pictures. The planes here are not: x is right. */
    RLF_FRAME_UNMIRRORED = 1,
    /* The device or the file had warped one picture into the other's camera already. */
    RLF_FRAME_ALIGNED = 2,
    /* The frame does not follow the one before it: a seek, a loop, a camera that came back. What
     * was learnt from earlier frames may not hold. */
    RLF_FRAME_DISCONTINUITY = 4
} rlf_frame_flag;

/* One depth picture, with colour where the source has it. The planes are the source's, read only,
 * and stay valid until its next frame: who needs them for longer copies them. */
typedef struct rlf_frame {
    uint64_t sequence; /* counts up by one per frame that the device made; gaps are lost frames */
    /* Device time, nanoseconds; increases from frame to frame. This and the next two lie within
     * RLF_TIME_MAX_NS: a frame with another time is refused. */
    int64_t time_ns;
    int64_t host_time_ns;  /* rlf_clock_ns() when the frame reached this machine; 0 = unknown, as in
                              files */
    int64_t color_time_ns; /* device time of the colour picture; 0 = as time_ns */
    uint32_t flags;        /* rlf_frame_flag */
    const rlf_rig *rig;    /* the source's, for its life */

    /* Depth along z (not along the ray), rig->depth.width x height. Exactly one of the two is set.
     */
    const uint16_t *depth_u16;    /* in units; 0 = missing */
    const float *depth_f32;       /* metres; <= 0, NaN and infinite = missing */
    ptrdiff_t depth_stride;       /* bytes */
    double depth_units_per_metre; /* of depth_u16: 1000 for millimetres */

    /* Colour, rig->color.width x height; data NULL when this frame has none. */
    rlf_image_rgba8 color;

    /* How sure the device is of each depth pixel, 255 = sure; NULL = it does not say. */
    const uint8_t *confidence;
    ptrdiff_t confidence_stride; /* bytes */

    /* Where the device or the file says the depth camera was; the world is the source's own. */
    bool has_pose;           /* false: T_world_camera means nothing */
    rlf_pose T_world_camera; /* depth camera in the world */
} rlf_frame;

/* RLF_OK, or RLF_ERROR_INVALID with a line that says what is wrong (`who` is put in front of it):
 * depth that is not one plane of rows as long as the rig says, units that are none (1 to 1000000),
 * colour of another size, times beyond RLF_TIME_MAX_NS. Not its pose: who uses that says what is
 * wrong with it. rlf_source_next gives no frame that fails. Reads no pixel. */
RLF_API rlf_result rlf_frame_check(const rlf_rig *rig, const rlf_frame *frame, const char *who);

#ifdef __cplusplus
}
#endif
#endif
