/* The camera's pose of each frame, tracked against the map that the frames before it made. */
#ifndef RELIEF_PIPELINE_CAMERA_POSE_H
#define RELIEF_PIPELINE_CAMERA_POSE_H

#include "pipeline/moving/settled.h"
#include "relief/map.h"
#include "relief/track.h"

typedef struct camera_pose {
    rlf_tracker *tracker;
    rlf_camera camera;         /* that is predicted for: a quarter of the depth camera's size */
    rlf_depth_noise noise;     /* of the depth camera */
    rlf_track_result last;     /* of the last frame */
    rlf_prediction prediction; /* at the last pose, when there is one */
    bool has_prediction;
    /* What the next frame is aligned with: the prediction, but while the camera rests what was
     * predicted when it came to rest, so that it cannot drift with what is fused meanwhile. */
    rlf_prediction reference;
    bool has_reference;
    float *planes[2]; /* of both */
    uint8_t *grey[2];
    settled settled;
    bool has_first;
    bool may_fuse;       /* the last pose is trusted: good, and for a while after a lost track */
    int32_t proven;      /* good frames since the track was lost, at most PROOF_FRAMES */
    int32_t since_fence; /* good frames */
    int64_t time_ns;     /* of the last frame */
    int64_t lost_count;  /* frames */
    double predict_ms, align_ms; /* of the last frame */
} camera_pose;

/* Close what was opened, also after an error. */
rlf_result camera_pose_open(camera_pose *c, const rlf_rig *rig, rlf_pool *pool);
/* A map that is known already: the camera is looked for where that was seen from. */
rlf_result camera_pose_know(camera_pose *c, rlf_map *map);
/* Finds the pose of a frame whose depth is `surface`'s; `grey` may be NULL. The first frame's is
 * the identity. */
rlf_result camera_pose_find(camera_pose *c, rlf_map *map, const rlf_surface *surface,
                            const uint8_t *grey, int64_t time_ns);
/* c->prediction of a pose that was found otherwise. */
rlf_result camera_pose_predict(camera_pose *c, rlf_map *map, const rlf_pose *T_world_camera);
/* Pixels of the frame that was found last in front of the room that is known, or that have come
 * lately: 0, else 1. For who has no foreground. */
void camera_pose_mark_static(camera_pose *c, const rlf_surface *surface, uint8_t *is_static);
void camera_pose_close(camera_pose *c);

#endif
