/* What the map adds to the picture: the back sheet of the room where the frame has no depth, and
 * the view of the whole room.
 *
 * The order of predictions: a map keeps its last one only. The tracker's comes first in a frame,
 * room_view_see takes over what it needs of it, and only then room_view_look predicts from the
 * view's camera, as often as it is asked. Afterwards the frame's prediction is gone. */
#ifndef RLF_PIPELINE_ROOM_VIEW_H
#define RLF_PIPELINE_ROOM_VIEW_H

#include "relief/compositor.h"
#include "relief/map.h"

/* When so many positions are there every second one leaves, and they are twice as far apart. */
#define ROOM_VIEW_PATH 4096

typedef struct room_view {
    rlf_surface surface; /* of the last frame, with what the room adds */
    bool has_surface;
    float *depth, *normal[3]; /* its background; work memory of the grid's size */

    rlf_vec3 path[ROOM_VIEW_PATH]; /* world, metres */
    int32_t path_count;
    double path_step_m;     /* between two positions */
    rlf_pose T_world_first; /* where the path begins */

    rlf_prediction prediction;
    rlf_room_sight sight;
} room_view;

/* Nothing of it is known, as at the start: a zeroed one is that, too. */
void room_view_clear(room_view *v);
void room_view_destroy(room_view *v);

/* One frame: the camera was there, and saw that. Lost pixels of the surface whose background is not
 * known take that of `room`, seen from about there; NULL = there is none. RLF_ERROR_MEMORY, only
 * when first there is a room. */
rlf_result room_view_see(room_view *v, const rlf_surface *surface, const rlf_pose *T_world_camera,
                         const rlf_prediction *room, rlf_pool *pool);
/* What the picture is made with: the frame's surface, or that with what the room adds. */
const rlf_surface *room_view_surface(const room_view *v, const rlf_surface *surface);

/* The room from an orbit (rlf_room_look). NULL when nothing is known, or map is NULL. */
const rlf_room_sight *room_view_look(room_view *v, rlf_map *map, const rlf_compositor_def *def,
                                     const rlf_orbit *orbit);

#endif
