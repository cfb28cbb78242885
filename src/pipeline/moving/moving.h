/* A camera that moves: its pose of each frame, the map of the room that it has seen, and the
 * surface in front of that. */
#ifndef RELIEF_PIPELINE_MOVING_H
#define RELIEF_PIPELINE_MOVING_H

#include "relief/camera.h"
#include "relief/frame.h"
#include "relief/map.h"
#include "relief/pipeline.h"
#include "relief/prediction.h"
#include "relief/surface.h"
#include "relief/track.h"

/* ---- settled.c */
/* What has come or gone lately is not the room: a place is known only when an earlier look agrees.
 */

/* An earlier frame at a quarter of the size. */
typedef struct settled_look {
    float *depth; /* metres; 0 = none */
    rlf_pose T_world_camera;
    int64_t time_ns;
} settled_look;

typedef struct settled {
    rlf_camera camera; /* of the looks; without distortion */
    rlf_depth_noise noise;
    settled_look look[2]; /* older, newer */
    int32_t count;
} settled;

/* Close what was opened, also after an error. */
rlf_result settled_open(settled *t, const rlf_camera *camera, const rlf_depth_noise *noise);
/* Takes 4 x 4 pixels out of `is_static` that are not on the known room and were seen to be free
 * within the last second, or stand behind something that has left since: who walks is nowhere for
 * so long. Then the frame may become one to compare with. `room` is the prediction at its pose;
 * NULL = nothing is known. */
void settled_mark(settled *t, const rlf_prediction *room, const rlf_surface *surface,
                  const rlf_pose *T_world_camera, uint8_t *is_static);
void settled_close(settled *t);

/* ---- camera_pose.c */
/* The camera's pose of each frame, tracked against the map that the frames before it made. */

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
/* Whether a point of the last frame, in camera coordinates, lies on what the map shows there. */
bool camera_pose_is_of_room(const camera_pose *c, rlf_vec3 point);
void camera_pose_close(camera_pose *c);

/* ---- absorb.c */
/* What was put down becomes the room: foreground that has stood still for so long is fused. */

enum { ABSORB_THINGS = 64, ABSORB_LABELS = 64 };

/* A region of the front sheet that stands still. */
typedef struct absorb_thing {
    rlf_vec3 place; /* of its centroid when it was first seen there; world, metres */
    double radius;  /* half of its box's diagonal */
    int64_t since_ns, seen_ns;
} absorb_thing;

/* A zeroed one is as at the start. */
typedef struct absorb {
    absorb_thing thing[ABSORB_THINGS];
    int32_t thing_count;
    int32_t label[ABSORB_LABELS]; /* of this frame's regions that are room now */
    int32_t label_count;
} absorb;

/* One frame: what has stood for after_s where it stands, and parts of that, is room. after_s <= 0:
 * nothing ever is. */
void absorb_update(absorb *a, const rlf_surface *surface, const rlf_pose *T_world_camera,
                   double after_s);
/* Whether region `label` of that frame is room now. */
bool absorb_is_room(const absorb *a, int32_t label);

/* ---- color_view.c */
/* The colour of each depth pixel, for the map and the tracker. */

typedef struct color_view {
    rlf_pool *pool;
    rlf_registration *registration;
    uint8_t *rgba, *grey; /* a depth pixel each; NULL = the rig has no colour */
} color_view;

/* Close what was opened, also after an error. */
rlf_result color_view_open(color_view *c, const rlf_rig *rig, rlf_pool *pool);
/* False when the frame has no colour. */
bool color_view_take(const color_view *c, const rlf_frame *frame, const rlf_surface *s);
void color_view_close(color_view *c);

/* ---- room_planes.c */
/* A prediction of the room, pixel by pixel of the depth camera's grid. */

typedef struct room_planes {
    float *depth, *normal[3]; /* a pixel of the grid each; 0 = unknown */
    /* Also of each: the first of the four predicted pixels about it, and the nearest. */
    int32_t *first, *nearest;
    struct room_plane *planes; /* of the predicted pixels; behind the last one: none */
} room_planes;

/* `lens` is the camera of the grid, `predicted` that of all predictions. Close what was opened,
 * also after an error. */
rlf_result room_planes_open(room_planes *r, const rlf_camera *lens, const rlf_camera *predicted);
/* Where `p`, predicted for the camera that saw `s`, has a step, a pixel gets the nearer side: what
 * is beside an edge of the room does not stand in front of it. */
void room_planes_take(const room_planes *r, const rlf_prediction *p, const rlf_surface *s,
                      rlf_pool *pool);
void room_planes_close(room_planes *r);

/* ---- source_pose.c */
/* The source's own poses, as places in the map's world. */

typedef struct source_poses {
    rlf_pose T_world_first; /* where the first frame with a pose is taken to be */
    double reach_m;         /* of the world from its origin, along each axis */
    bool has_first, has_told;
    rlf_pose T_world_source;
} source_poses;

/* For a map with such voxels. */
source_poses source_poses_begin(const rlf_pose *T_world_first, double voxel_m);
/* Where the camera was. False when the frame has no pose, one that is none, or one that is beyond
 * what a map can hold; the first such frame is named in a warning,
 * and *out stays. */
bool source_poses_take(source_poses *s, const rlf_frame *frame, rlf_pose *out);

/* ---- moving.c, moving_frame.c */
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
