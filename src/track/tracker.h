/* The tracker's memory. */
#ifndef RLF_TRACK_TRACKER_H
#define RLF_TRACK_TRACKER_H

#include "track/normal_equations.h"

#define TRACK_THUMB_WIDTH 32
#define TRACK_THUMB_HEIGHT 24
#define TRACK_THUMB (TRACK_THUMB_WIDTH * TRACK_THUMB_HEIGHT)

/* A view in little: means of blocks; 0 = none. */
typedef struct track_thumbnail {
    float depth[TRACK_THUMB]; /* metres */
    float grey[TRACK_THUMB];
} track_thumbnail;

typedef struct track_keyframe {
    track_thumbnail view;
    rlf_pose T_world_camera;
} track_keyframe;

struct rlf_tracker {
    rlf_tracker_def def;
    float *ray_x, *ray_y;
    track_points points;
    track_keyframe *keyframes;
    int32_t keyframe_count;
    /* The last two poses that were not lost. */
    rlf_pose pose, before;
    int64_t time_ns, before_ns;
    int32_t pose_count; /* 0, 1 or 2 of them are known */
};

/* Of planes of width x height; grey may be NULL. */
void track_thumbnail_make(int32_t width, int32_t height, const float *plane, const uint8_t *luma,
                          track_thumbnail *out);
/* How unlike two thumbnails are where b, moved by (dx, dy) cells, lies on a: 0 = alike; 1 where
 * they have nothing in common. */
double track_thumbnail_difference(const track_thumbnail *a, const track_thumbnail *b, int32_t dx,
                                  int32_t dy);

#endif
