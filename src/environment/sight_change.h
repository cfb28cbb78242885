/* Whether the camera has moved so far that what is remembered pixel by pixel is no longer there. */
#ifndef RLF_ENVIRONMENT_SIGHT_CHANGE_H
#define RLF_ENVIRONMENT_SIGHT_CHANGE_H

#include "relief/camera.h"

/* A zeroed one remembers nothing. */
typedef struct sight_change {
    rlf_pose T_world_camera; /* where the memory began */
    bool has_pose;
} sight_change;

/* True when something between `nearest_m` and far away is now a pixel of `camera`, or more, from
 * where it was when the memory began; it then begins anew here. The first pose is no change, and a
 * standing camera's never is. */
bool sight_change_update(sight_change *c, const rlf_pose *T_world_camera, const rlf_camera *camera,
                         double nearest_m);

#endif
