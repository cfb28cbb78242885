/* What has come or gone lately is not the room: a place is known only when an earlier look agrees.
 */
#ifndef RELIEF_PIPELINE_SETTLED_H
#define RELIEF_PIPELINE_SETTLED_H

#include "relief/prediction.h"
#include "relief/surface.h"

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

#endif
