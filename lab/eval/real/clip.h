/* A piece of a real recording in memory, which can be turned, edited and played. */
#ifndef RELIEF_APP_EVAL_REAL_CLIP_H
#define RELIEF_APP_EVAL_REAL_CLIP_H

#include "relief/io.h"

/* Frames one behind the other; all owned. */
typedef struct real_clip {
    rlf_rig rig;
    double units_per_metre;
    int32_t count;
    int64_t *time_ns;
    uint16_t *depth;    /* units; 0 = missing */
    uint8_t *color;     /* RGBA; NULL = none */
    uint8_t *has_color; /* per frame */
} real_clip;

/* Frames first <= i < first + count of a folder, or as many of them as there are. */
rlf_result real_clip_load(const char *folder, int32_t first, int32_t count, real_clip *out);
/* One frame of depth.png and color.png, Kinect v1: f 525, centre (319.5, 239.5), millimetres. */
rlf_result real_clip_load_single(const char *folder, real_clip *out);
void real_clip_free(real_clip *clip);
static inline int32_t real_clip_pixels(const real_clip *clip)
{
    return clip->rig.depth.width * clip->rig.depth.height;
}
/* Depth of frame `index`. */
static inline uint16_t *real_clip_depth(const real_clip *clip, int32_t index)
{
    return clip->depth + (size_t)index * (size_t)real_clip_pixels(clip);
}

/* The scene as a camera sees it that is rolled: pictures and cameras are mirrored (left and right)
 * if asked for, then turned clockwise by `quarters` of a full turn. */
rlf_result real_clip_turn(const real_clip *clip, int32_t quarters, bool is_mirrored,
                          real_clip *out);
/* The same for a direction in the camera's frame. */
rlf_vec3 real_turn_vector(rlf_vec3 v, int32_t quarters, bool is_mirrored);
/* The same for a camera. */
rlf_camera real_turn_camera(const rlf_camera *camera, int32_t quarters, bool is_mirrored);

/* Plays the clip `passes` times over; it must stay as it is meanwhile. */
rlf_result real_clip_source(const real_clip *clip, int32_t passes, rlf_source **out);

/* What is told of each frame; `index` counts over all passes. */
typedef rlf_result (*real_surface_fn)(void *context, const rlf_frame *frame,
                                      const rlf_surface *surface, int32_t index);
/* The surface stage of profile live on every frame. */
rlf_result real_clip_surfaces(const real_clip *clip, int32_t passes, real_surface_fn take,
                              void *context);

#endif
