/* What velocity and the camera's own motion keep from frame to frame. */
#ifndef RLF_SURFACE_MOTION_STATE_H
#define RLF_SURFACE_MOTION_STATE_H

#include "base/arena.h"
#include "surface/frame.h"
#include "surface/thickness/state.h"

/* Keyframes at a time: see motion/keyframe.h. */
enum { RLF_KEYFRAMES = 48 };

typedef struct velocity_planes {
    float *seen;                   /* plane: of the frame before */
    struct rlf_cell *cells;        /* of motion/cells.c */
    uint8_t *is_steady;            /* plane, scratch */
    struct rlf_keyframe *keyframe; /* RLF_KEYFRAMES */
    bool is_taken[RLF_PIECES + 1]; /* of each of the background's things: it has one ... */
    int32_t next_thing;            /* ... or it was not yet asked, from this one on */
} velocity_planes;

void velocity_allocate(velocity_planes *state, rlf_arena *arena, const image_grid *grid);

/* ---- ego_motion.c: whether the camera itself moves */
/* What is seen of an earlier frame, see ego_motion.c. */
enum { RLF_EGO_POINTS = 640 };

typedef struct rlf_ego_point {
    rlf_vec3 point, normal;
    int32_t pixel;
} rlf_ego_point;

typedef struct rlf_ego_view {
    rlf_ego_point points[RLF_EGO_POINTS];
    int32_t count;
} rlf_ego_view;

typedef struct rlf_ego_motion {
    rlf_ego_view views[2]; /* two earlier frames; motion is asked since the older one */
    int32_t newest, age;   /* of the views; age: frames since it was seen */
    rlf_pose newest_pose;  /* its points' motion since the older one */
    rlf_pose pose, step;   /* motion since the older one, and that of the last frame */
    rlf_pose found;        /* motion when it was seen last */
    int32_t seen_frames;   /* in a row in which the camera moved */
    int32_t hold;          /* frames for which it is still taken to move */
    bool moves;
    bool rests; /* enough of the view is where it was */
} rlf_ego_motion;

void rlf_ego_motion_reset(rlf_ego_motion *ego);

/* Sets stage->ego.moves and .rests by a frame's depth as it came: a plane. */
void rlf_ego_motion_watch(rlf_reconstruct *stage, const float *depth);

/* The frame that was just made may be the one that later ones are compared with. */
void rlf_ego_motion_remember(rlf_reconstruct *stage, const rlf_slot *slot);

#endif
