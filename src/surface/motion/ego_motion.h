/* Whether the camera itself moves. */
#ifndef RLF_SURFACE_MOTION_EGO_MOTION_H
#define RLF_SURFACE_MOTION_EGO_MOTION_H

#include "base/arena.h"
#include "surface/frame.h"

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
