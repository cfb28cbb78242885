/* Relief: the surface stage. rlf_frame in, rlf_surface out.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_RECONSTRUCT_H
#define RELIEF_RECONSTRUCT_H

#include "relief/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Which methods a stage takes. */
typedef enum rlf_profile {
    RLF_PROFILE_LIVE = 0,  /* our best method for each stage, at scale factor 1 */
    RLF_PROFILE_THESIS = 1 /* the method as written, at scale factor 8 */
} rlf_profile;

/* How normals are found. */
typedef enum rlf_normal_method {
    RLF_NORMALS_SIX_FACES = 0, /* mean weighted equally over the six incident triangles (eq. 4.2) */
    RLF_NORMALS_FOUR_FACES = 1,   /* four faces: up, left, down, right (fig. 4.7) */
    RLF_NORMALS_THESIS = 2,       /* eq. 4.3, with fig. 4.8's rules at borders and corners */
    RLF_NORMALS_INVERSE_DEPTH = 3 /* exact 1/z form (errata 1), edge-aware, faces the camera */
} rlf_normal_method;

/* What tells the room from what moves in it. */
typedef enum rlf_background_method {
    RLF_BACKGROUND_OFF = 0,      /* every pixel is front sheet; no background */
    RLF_BACKGROUND_AVERAGE = 1,  /* thesis 4.4.1: mean of the first frames, static for ever */
    RLF_BACKGROUND_ADAPTIVE = 2, /* per pixel, one-sided noise-scaled test, replaced by evidence */
    RLF_BACKGROUND_GIVEN = 3     /* the camera moves: give_background tells for each frame */
} rlf_background_method;

/* What cuts a layer into regions. */
typedef enum rlf_segment_method {
    RLF_SEGMENT_OFF = 0,    /* the whole layer is one region */
    RLF_SEGMENT_THESIS = 1, /* eq. 4.4 in two directions, AND, 4-connected regions, dilation */
    RLF_SEGMENT_NOISE = 2,  /* depth difference scaled with noise and slope */
    RLF_SEGMENT_OBJECTS = 3 /* as NOISE; planes that things stand on are regions of their own, and
                               things that touch are parted where they meet in a concave edge */
} rlf_segment_method;

/* What is known of the room where the camera is now. Planes of the grid's size, which hold until
 * the frame is finished. */
typedef struct rlf_given_background {
    const float *depth;                          /* metres along z; 0 = unknown */
    const float *normal_x, *normal_y, *normal_z; /* unit, towards the camera; 0 = unknown */
    double slack_m;        /* how far the depth may be off, beside the sensor's noise */
    rlf_pose T_now_before; /* the frame before's camera in this one's frame */
    bool has_before;       /* that is known */
} rlf_given_background;

/* Called once a frame when its depth, normals, reasons, rays and time are in *seen; all else there
 * means nothing yet. False = the camera's place is not known: all is one sheet at rest. */
typedef bool (*rlf_give_background_fn)(void *context, const rlf_surface *seen,
                                       rlf_given_background *out);

/* All settings of the surface stage. Any mix of methods can be run. */
typedef struct rlf_reconstruct_def {
    uint32_t cookie;      /* from rlf_reconstruct_def_default */
    rlf_rig rig;          /* the source's; must be set */
    int32_t scale_factor; /* 1..64; live 1, thesis 8 */
    double depth_min_m;   /* nearer = too near; default from the rig */
    double depth_max_m;   /* farther = too far; default from the rig */

    rlf_normal_method normal_method; /* live: inverse depth */
    bool normals_face_camera;        /* true: n.p < 0 (errata 2); false: n_z < 0 as in eq. 4.3 */

    rlf_segment_method background_segment; /* thesis: THESIS */
    rlf_segment_method foreground_segment; /* thesis: OFF (one person), or THESIS (several) */
    double segment_tau_m; /* eq. 4.4 threshold, metres (see docs/conventions.md for defaults) */
    bool enable_dilation; /* fig. 4.12 */
    int32_t min_region_points; /* smaller regions are dropped (label 0) */
    int32_t region_capacity;   /* most regions of one surface; further ones are dropped by size */
    bool keep_region_points;   /* fill region_points; the thesis collision needs it */

    rlf_background_method background_method; /* live: adaptive */
    rlf_give_background_fn give_background;  /* GIVEN: must be set */
    void *give_context;                      /* given to give_background */
    int32_t background_frames;               /* frames averaged at start; default 5 */
    double foreground_threshold_m;           /* AVERAGE: |z - z_bg| above this is foreground */
    double foreground_sigmas; /* ADAPTIVE, GIVEN: z_bg - z above this many sigma(z) ... */
    double foreground_min_m;  /* ... and above this, metres */
    double absorb_after_s; /* ADAPTIVE: still foreground becomes background; default 20, 0 never */

    /* live: true: takes off pixels that mix the depths of both sides of an edge. They lie on no
     * surface; their reason is FLYING. */
    bool enable_flying_removal;
    /* live: true: fills small holes (reason FILLED), each from the side of the edge that the known
     * pixels about it vote for. What lies in the sensor's shadow shows the farther side. Without
     * it, such pixels have no depth. */
    bool enable_fill;
    bool enable_smoothing; /* live: true: averages depth within planes, as far as the sensor's noise
                              explains what it takes away; never across an edge or a crease */
    bool enable_wide_planes; /* live: true, needs smoothing: planes up to 40 pixels wide where the
                                sensor is rough, as structured light is; others are not touched */
    bool enable_steadying;   /* live: true: averages depth that does not change over 32 frames; what
                                changes by more than the noise starts anew */
    bool enable_hold; /* live: true, needs steadying: a dropped pixel keeps what was seen there
                         (reason FILLED) while nothing moves beside it */
    bool enable_edge_normals; /* live: true, needs smoothing: normals of creases from the faces that
                                 meet there, of filled outlines from how the surface turns away;
                                 with steadying, what most frames of a second agree on, for the
                                 background's */
    bool enable_velocity;     /* live: true: normal velocity from depth change along the ray */
    bool enable_thickness;    /* live: true: the back that the front's own curvature shows */
    bool enable_coast; /* live: true, needs velocity, thickness: thin things go on for 0.3 s where a
                          gap hides them, and keep the depth that was seen before they turned; flat
                          ones, a book in a hand, are followed as boxes (Harris 1990) */

    bool enable_color_sides; /* live: true, needs fill: at edges of what moves the colour picture
                                helps to decide on which side of the edge a dropped pixel is. The
                                picture's offset is learnt, and it is not asked while it does not
                                fit depth; without colour nothing changes */

    rlf_pool *pool; /* borrowed; NULL = one thread; a grid below 8192 pixels has one anyway */
} rlf_reconstruct_def;

/* Settings of a profile; `rig` is copied and its range becomes the default range. */
RLF_API rlf_reconstruct_def rlf_reconstruct_def_default(rlf_profile profile, const rlf_rig *rig);

/* Surfaces stay valid for this many further calls of rlf_reconstruct_process. */
#define RLF_RECONSTRUCT_SURFACES 3

/* The surface stage: one camera's background and history. One thread at a time. */
typedef struct rlf_reconstruct rlf_reconstruct;

/* Allocates everything that will ever be needed. */
RLF_API rlf_result rlf_reconstruct_create(const rlf_reconstruct_def *def, rlf_reconstruct **out);
/* Frees it and nulls the pointer. NULL and a NULL stage are allowed. */
RLF_API void rlf_reconstruct_destroy(rlf_reconstruct **stage);

/* Makes the surface of one frame. *out_surface is the stage's and stays valid and unchanged during
 * the next RLF_RECONSTRUCT_SURFACES - 1 calls. Allocates nothing. A frame with all pixels missing
 * is not an error. RLF_ERROR_INVALID when the frame has no depth plane. Thread-safety: one call at
 * a time per object. */
RLF_API rlf_result rlf_reconstruct_process(rlf_reconstruct *stage, const rlf_frame *frame,
                                           const rlf_surface **out_surface);
/* Steps of one frame, in the order in which they run; those that are switched off take no time. */
typedef enum rlf_surface_step {
    RLF_SURFACE_READ = 0,   /* raw depth to metres, with reasons */
    RLF_SURFACE_FLYING,     /* mixed pixels off */
    RLF_SURFACE_SMOOTH,     /* planes fitted to windows: smoothed depth and, with it, normals */
    RLF_SURFACE_FILL,       /* holes filled */
    RLF_SURFACE_COMPLETE,   /* normals where the smoothing left none, and of outlines and creases */
    RLF_SURFACE_STEADY,     /* averaging over time, dropped pixels recalled */
    RLF_SURFACE_BACKGROUND, /* background model and foreground */
    RLF_SURFACE_NORMALS,    /* normals that were not made with the depth */
    RLF_SURFACE_SEGMENT,    /* regions and labels */
    RLF_SURFACE_VELOCITY,
    RLF_SURFACE_THICKNESS,
    RLF_SURFACE_PUBLISH, /* counts of the finished surface */
    RLF_SURFACE_STEP_COUNT
} rlf_surface_step;

/* Name of a step, e.g. "background". */
RLF_API const char *rlf_surface_step_name(rlf_surface_step step);

/* Wall time of the surface stage's steps. */
typedef struct rlf_surface_times {
    double step_ms[RLF_SURFACE_STEP_COUNT]; /* of the last frame */
} rlf_surface_times;

/* From now on each frame writes the time of its steps to *times, which is borrowed; NULL (the
 * default) measures nothing and costs nothing. Results never depend on it. */
RLF_API void rlf_reconstruct_set_times(rlf_reconstruct *stage, rlf_surface_times *times);

/* Forgets the background and all history: the next frame is the first. */
RLF_API void rlf_reconstruct_reset(rlf_reconstruct *stage);
/* Whether a depth plane of the same camera, metres along z and 0 = missing, shows what the stage
 * saw up to 16 frames before its newest one: at least half of the picture's parts are where they
 * were, whatever moves before the others. */
RLF_API bool rlf_reconstruct_is_as_before(const rlf_reconstruct *stage, const float *depth);

/* Normals of any organised depth grid, for measuring a method by itself: camera and rays as in
 * rlf_surface, noise NULL for clean depth. out planes hold width*height floats, 0 where there is
 * no normal. Allocates nothing. */
RLF_API void rlf_compute_normals(rlf_normal_method method, bool face_camera, int32_t width,
                                 int32_t height, const float *ray_x, const float *ray_y,
                                 const float *depth, const rlf_depth_noise *noise, float *out_x,
                                 float *out_y, float *out_z);

#ifdef __cplusplus
}
#endif
#endif
