/* Where the camera is: it stands, or it moves. */
#ifndef RELIEF_PIPELINE_CAMERA_H
#define RELIEF_PIPELINE_CAMERA_H

#include "pipeline/moving.h"

typedef struct camera {
    rlf_pose T_world; /* of the newest frame */
    moving moving;
    bool is_watched;  /* it may begin to move */
    float *still;     /* AUTO: the background of a standing camera, a plane; NULL = not asked for */
    bool has_still;   /* it holds one */
    int64_t still_ns; /* when it was kept */
    bool has_told;    /* that it moves, though it is to stand */
} camera;

#endif
