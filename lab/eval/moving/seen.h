/* The room of a moving synthetic source as physics sees it: true depth and normals, few pixels. */
#ifndef RELIEF_APP_EVAL_MOVING_SEEN_H
#define RELIEF_APP_EVAL_MOVING_SEEN_H

#include "relief/synthetic.h"
#include "relief/world.h"

enum { SEEN_W = 192, SEEN_H = 160, SEEN_PIXELS = SEEN_W * SEEN_H };

typedef struct seen_room {
    rlf_source *source;      /* borrowed; nothing may move in it */
    rlf_pose T_world_source; /* where the source's camera stands */
    float ray_x[SEEN_PIXELS], ray_y[SEEN_PIXELS];
    float depth[SEEN_PIXELS], normal[3][SEEN_PIXELS];
    rlf_vec3 ways[SEEN_PIXELS];
    rlf_grid grid;
} seen_room;

/* `T_world_source`: the camera of the source's last frame. */
void seen_room_start(seen_room *seen, rlf_source *source, const rlf_pose *T_world_source);
/* The grid of a camera at that pose, a thirtieth of a second after the last. */
rlf_result seen_room_look(seen_room *seen, const rlf_pose *T_world_camera);
/* The depth camera that sees so. */
rlf_camera seen_room_camera(void);
/* Distance of a world point to the true room, metres; negative inside. */
double seen_room_distance(const seen_room *seen, rlf_vec3 p);

#endif
