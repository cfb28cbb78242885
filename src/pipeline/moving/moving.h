/* A camera that moves: its pose of each frame, the map of the room that it has seen, and the
 * surface in front of that. */
#ifndef RELIEF_PIPELINE_MOVING_H
#define RELIEF_PIPELINE_MOVING_H

#include "relief/pipeline.h"

#include "pipeline/moving/absorb.h"
#include "pipeline/moving/camera_pose.h"
#include "pipeline/moving/color_view.h"
#include "pipeline/moving/room_planes.h"
#include "pipeline/moving/source_pose.h"

typedef struct moving {
    bool is_on;
    rlf_rig rig;
    rlf_pool *pool;
    rlf_pose_origin poses;
    rlf_reconstruct *stage;
    rlf_map *map;
    bool owns_map;
    camera_pose pose;
    source_poses source;
    color_view color;
    bool has_color; /* of this frame */
    room_planes planes;
    bool has_room;      /* pose.prediction is what stands behind the frame */
    uint8_t *is_static; /* a depth pixel each */
    absorb still;
    double absorb_after_s;
    const rlf_frame *frame; /* while it is processed */
    rlf_pose T_world_camera, T_world_before;
    bool has_before;
    rlf_track_result track;
    rlf_track_health told;
    bool has_fence;
    rlf_result result;
} moving;

/* What a camera has seen that stood until now. */
typedef struct moving_from {
    rlf_pose T_world_camera; /* where it stood */
    const float *still;      /* the background: a plane; NULL = none is known */
    int64_t time_ns;         /* of this frame */
    rlf_pose T_now_before;   /* how far it has moved already */
} moving_from;

/* Begins where a camera stood; `from` may be NULL the first time: the first frame is seen from the
 * def's pose. Goes on with the map that it has, if it moved before. May allocate. */
rlf_result moving_start(moving *m, const rlf_pipeline_def *def, const moving_from *from);
/* The surface of a frame, m->T_world_camera and m->track. */
rlf_result moving_process(moving *m, const rlf_frame *frame, const rlf_surface **out);
/* moving_frame.c: the surface stage asks it for the room; context = the moving. */
bool moving_give(void *context, const rlf_surface *seen, rlf_given_background *out);
/* Fuses a view into all of its blocks, however long it takes: the first one, which all others are
 * placed by. */
rlf_result moving_fuse_whole(moving *m, const rlf_map_view *view, const rlf_pose *T_world_camera);
/* False while the camera's pose is not known: then nothing is known of what bodies could meet. */
static inline bool moving_is_placed(const moving *m)
{
    return m->track.health != RLF_TRACK_LOST;
}
/* Off again, with nothing kept but a map that is the caller's. Also after an error. */
void moving_stop(moving *m);

#endif
