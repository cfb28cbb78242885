/* Where the camera is: it stands, or it moves. */
#ifndef RELIEF_PIPELINE_CAMERA_H
#define RELIEF_PIPELINE_CAMERA_H

#include "pipeline/moving/moving.h"

typedef struct camera {
    rlf_pose T_world; /* of the newest frame */
    moving moving;
    bool is_watched;     /* it may begin to move */
    float *still;        /* AUTO: two planes, the background of a standing camera; else NULL */
    int64_t still_ns[2]; /* when each was kept */
    int32_t still_count; /* so often one was; they take turns */
    bool has_told;       /* that it moves, though it is to stand */
} camera;

#endif
