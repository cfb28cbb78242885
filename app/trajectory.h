/* The camera's way: a list of poses, and how far it is from the truth. */
#ifndef RELIEF_APP_TRAJECTORY_H
#define RELIEF_APP_TRAJECTORY_H

#include "relief/base.h"
#include "relief/math.h"

typedef struct trajectory {
    int64_t *time_ns;
    rlf_pose *found; /* camera in the world */
    rlf_vec3 *truth; /* the camera's place as the source says it */
    int32_t count, room;
} trajectory;

/* Both may be called with `truth` NULL: then there is no error to tell. */
rlf_result trajectory_add(trajectory *t, int64_t time_ns, const rlf_pose *found,
                          const rlf_pose *truth);
/* Absolute trajectory error, metres: root mean square distance after the best rigid motion (Sturm
 * et al. 2012). Negative when there are fewer than three poses. */
double trajectory_error(const trajectory *t);
void trajectory_free(trajectory *t);

#endif
