/* The view of the whole room: where it is seen from, and the camera's way in it.
 */
#ifndef RLF_PIPELINE_ROOM_VIEW_H
#define RLF_PIPELINE_ROOM_VIEW_H

#include "relief/compositor.h"
#include "relief/map.h"
#include "relief/surface.h"

/* When so many positions are there every second one leaves, and they are twice as far apart. */
#define ROOM_VIEW_PATH 4096

/* A zeroed one is as at the start. */
typedef struct room_view {
    rlf_vec3 path[ROOM_VIEW_PATH]; /* world, metres */
    int32_t path_count;
    double path_step_m;     /* between two positions */
    rlf_pose T_world_first; /* where the path begins, */
    rlf_pose T_world_last;  /* and where the camera is now */
    rlf_aabb box;           /* about the path, and what was seen from there by and large */
    rlf_prediction prediction;
    rlf_room_sight sight;
} room_view;

/* One frame: the camera was there, and saw that. */
void room_view_pass(room_view *v, const rlf_pose *T_world_camera, const rlf_surface *surface);

/* The room from an orbit (rlf_room_look). NULL when nothing is known, or map is NULL. */
const rlf_room_sight *room_view_look(room_view *v, rlf_map *map, const rlf_compositor_def *def,
                                     const rlf_orbit *orbit);

#endif
