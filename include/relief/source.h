/* Relief: where frames come from. A camera, a folder, a recording and the synthetic room are all an
 * rlf_source; anyone can add one with rlf_source_create_custom.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_SOURCE_H
#define RELIEF_SOURCE_H

#include "relief/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is known of a source when it is open. Constant from then on. */
typedef struct rlf_source_info {
    char name[128];           /* as the user gave it, e.g. "synthetic:room" */
    rlf_rig rig;              /* its cameras, for its life */
    int64_t frame_count;      /* -1 = unknown or endless */
    double frames_per_second; /* nominal; 0 = unknown */
    bool is_live;             /* true: newest frame wins; false: lock-step, every frame */
    char device[128];         /* driver, model and serial number, or the format; "" = unknown */
    bool can_seek;            /* rlf_source_seek works */
    rlf_vec3 gravity;         /* m/s^2, in the depth camera's frame at the first frame, from how the
                                 camera is mounted; 0 = it does not know */
    bool is_simulated;        /* the pictures are computed: their light is that of a renderer */
} rlf_source_info;

/* What became of a source's frames so far. */
typedef struct rlf_source_status {
    uint64_t given;    /* frames that rlf_source_next gave */
    uint64_t lost;     /* that the device made and nobody got: gaps in its count or its times */
    uint64_t late;     /* live: overtaken by a newer one before they were asked for */
    uint64_t doubled;  /* came twice and were given once */
    uint64_t unpaired; /* given without colour, since no picture was near in time */
    uint64_t damaged;  /* could not be decoded */
    bool is_connected; /* false: the device is gone; the source goes on looking for it */
    double silence_s;  /* live: seconds since the last frame arrived; 0 for files */
} rlf_source_status;

/* What only a simulator knows, for the frame just given. All planes have the depth camera's size,
 * row-major without padding, in the depth camera's frame. */
typedef struct rlf_truth {
    const float *depth;                          /* z, metres, without noise; 0 = nothing hit */
    const float *normal_x, *normal_y, *normal_z; /* unit, towards the camera */
    const int32_t *label;      /* surface id > 0, one per object (the person is one); 0 = nothing */
    const uint8_t *foreground; /* 1 = belongs to something that was not there at start or moves */
    const float
        *thickness; /* z of the ray's exit from the object minus depth; 0 for the room shell */
    const float *velocity_x, *velocity_y, *velocity_z; /* m/s of the surface point */
    const float *background_depth;      /* z of the same room without the foreground, metres */
    const struct rlf_truth_pose *poses; /* what moves */
    int32_t pose_count;                 /* 0 = nothing moves */
} rlf_truth;

/* True pose of a moving object or limb. */
typedef struct rlf_truth_pose {
    char name[32];            /* of the object or limb */
    int32_t label;            /* as in rlf_truth.label */
    rlf_pose T_camera_object; /* the object in the depth camera's frame */
} rlf_truth_pose;

/* Something that gives frames, one after the other. One thread at a time; a live camera has a
 * thread of its own behind it. */
typedef struct rlf_source rlf_source;

/* Is shown a frame, maybe on a thread of the source's; frame and planes are good during the
 * call. */
typedef void (*rlf_frame_fn)(void *context, const rlf_frame *frame);

/* Fills *out_frame; its planes stay valid until the next call that returns RLF_OK. Returns RLF_OK,
 * RLF_NO_FRAME, RLF_END or an error. out_frame->rig is set by the caller. */
typedef rlf_result (*rlf_source_next_fn)(void *self, rlf_frame *out_frame);

/* Methods of a custom source; `self` is the context given at creation. */
typedef struct rlf_source_methods {
    rlf_source_next_fn next; /* required */
    /* Starts again with the first frame. NULL = cannot. */
    rlf_result (*restart)(void *self);
    /* Truth of the last frame, or NULL. NULL = never. */
    const rlf_truth *(*truth)(void *self);
    /* Frees the context. NULL = nothing to free. */
    void (*destroy)(void *self);
    /* Makes frame `index` (from 0) the next one. NULL = cannot. */
    rlf_result (*seek)(void *self, int64_t index);
    /* Fills *out, which is zero but for is_connected. NULL = only `given` is known. */
    void (*status)(void *self, rlf_source_status *out);
    /* Shows every frame that the device makes to `fn`, also those that `next` leaves out, on the
     * thread on which they come. fn NULL: no more, once the last call of it has returned. NULL =
     * all frames come by `next`. */
    void (*observe)(void *self, rlf_frame_fn fn, void *context);
} rlf_source_methods;

/* Makes a source of caller's methods. Copies both structs. On failure `self` is not destroyed. */
RLF_API rlf_result rlf_source_create_custom(const rlf_source_methods *methods,
                                            const rlf_source_info *info, void *self,
                                            rlf_source **out);
/* The `self` of a source that was made with this `next`; NULL for another kind of source. So the
 * author of a source finds his own again, and asks it what no other source knows. */
RLF_API void *rlf_source_get_self(const rlf_source *source, rlf_source_next_fn next);
/* Closes and nulls. NULL and a NULL source are allowed. */
RLF_API void rlf_source_destroy(rlf_source **source);

/* What the source is: size of the pictures, rate, device. The pointer and what it points to are
 * constant for the source's life. */
RLF_API const rlf_source_info *rlf_source_get_info(const rlf_source *source);
/* Next frame; its planes are the source's and stay valid until the next call that returns RLF_OK:
 * a call that gives no frame leaves the last one alone. RLF_ERROR_INVALID: the source made one that
 * rlf_frame_check refuses.
 * Thread-safety: one thread at a time. */
RLF_API rlf_result rlf_source_next(rlf_source *source, rlf_frame *out_frame);
/* Where depth is expected, metres; default the rig's range. When most depth of the first frame that
 * has any is outside, one warning asks whether its unit is right. min_m = max_m: it is not asked.
 * Thread-safety: as next. */
RLF_API void rlf_source_expect_range(rlf_source *source, double min_m, double max_m);
/* The first frame is the next one again. RLF_ERROR_UNSUPPORTED when the source cannot, as a
 * camera. */
RLF_API rlf_result rlf_source_restart(rlf_source *source);
/* Makes frame `index` (0 .. frame_count - 1) the next one. RLF_ERROR_UNSUPPORTED when the source
 * cannot, RLF_ERROR_INVALID when there is no such frame. */
RLF_API rlf_result rlf_source_seek(rlf_source *source, int64_t index);
/* What became of the frames so far. Thread-safety: as next. */
RLF_API rlf_source_status rlf_source_get_status(const rlf_source *source);
/* From now on `fn` is shown every frame that the device makes, also those that overtake each other
 * before rlf_source_next asks; on the thread on which they come, so it must be quick. NULL ends
 * that, once the last call has returned. False: all frames come by rlf_source_next, and `fn` is not
 * used. Thread-safety: as next. */
RLF_API bool rlf_source_observe(rlf_source *source, rlf_frame_fn fn, void *context);
/* Truth of the last frame, or NULL when the source knows none. Valid until the next call of next.
 * Thread-safety: as next; the first call for a frame may make the planes. */
RLF_API const rlf_truth *rlf_source_get_truth(rlf_source *source);

#ifdef __cplusplus
}
#endif
#endif
