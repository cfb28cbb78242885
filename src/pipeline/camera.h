/* Where the camera is: it stands, or it moves. */
#ifndef RLF_PIPELINE_CAMERA_H
#define RLF_PIPELINE_CAMERA_H

#include "pipeline/moving/moving.h"

typedef struct camera {
    rlf_pose T_world; /* of the newest frame */
    rlf_pose T_stood; /* where it stands, or stood last */
    bool has_stood;   /* the standing camera's stage remembers what it saw from there */
    moving moving;
    bool may_change;       /* it may begin to move, and stand again */
    float *still;          /* AUTO: two planes, the background of a standing camera; else NULL */
    float *room;           /* AUTO: a plane, what a camera that stands again begins with */
    int64_t still_ns[2];   /* when each was kept */
    int32_t still_count;   /* so often one was; they take turns */
    rlf_pose T_source;     /* what the source said when the camera began to stand, */
    bool has_source;       /* if it said anything */
    bool is_prepared;      /* `moving` has seen the first frame, in case that it moves */
    bool has_told;         /* that it moves, though it is to stand */
    bool was_placed;       /* at any time */
    bool rests;            /* while it moves: its view is as it was, since then: */
    int64_t rest_ns;       /* the time, and */
    rlf_pose T_rest;       /* where that was */
    int32_t before_frames; /* in a row that show what it saw where it stood last */
    int32_t taught_frames; /* of the room, to the standing camera's stage */
} camera;

#endif
