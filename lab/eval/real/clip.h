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

/* Plays the clip `passes` times over; it must stay as it is meanwhile. */
rlf_result real_clip_source(const real_clip *clip, int32_t passes, rlf_source **out);

/* What is told of each frame; `index` counts over all passes. */
typedef rlf_result (*real_surface_fn)(void *context, const rlf_frame *frame,
                                      const rlf_surface *surface, int32_t index);
/* The surface stage of profile live on every frame. */
rlf_result real_clip_surfaces(const real_clip *clip, int32_t passes, real_surface_fn take,
                              void *context);

#endif
