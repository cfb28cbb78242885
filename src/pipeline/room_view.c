/* Where the camera has been, and the room from an orbit. */
#include "pipeline/room_view.h"

#define PATH_STEP_M 0.01 /* at first; less is noise */

void room_view_pass(room_view *v, const rlf_pose *T_world_camera)
{
    if (v->path_count == 0) {
        v->T_world_first = *T_world_camera;
        v->path_step_m = PATH_STEP_M;
    } else {
        const rlf_vec3 way = rlf_sub(T_world_camera->p, v->path[v->path_count - 1]);
        if (!(rlf_dot(way, way) >= v->path_step_m * v->path_step_m)) {
            return;
        }
    }
    if (v->path_count == ROOM_VIEW_PATH) {
        for (int32_t i = 0; i < ROOM_VIEW_PATH / 2; i++) {
            v->path[i] = v->path[2 * i];
        }
        v->path_count = ROOM_VIEW_PATH / 2;
        v->path_step_m *= 2.0;
    }
    v->path[v->path_count++] = T_world_camera->p;
}

const rlf_room_sight *room_view_look(room_view *v, rlf_map *map, const rlf_compositor_def *def,
                                     const rlf_orbit *orbit)
{
    const rlf_map_status status =
        map != NULL ? rlf_map_get_status(map) : (rlf_map_status){.block_count = 0};
    if (status.block_count == 0) {
        return NULL;
    }
    const rlf_pose base = v->path_count > 0 ? v->T_world_first : rlf_pose_identity();
    rlf_camera camera;
    rlf_pose T_world_view;
    rlf_aabb box = status.box;
    for (int32_t i = 0; i < v->path_count; i++) {
        rlf_aabb_extend(&box, v->path[i]);
    }
    rlf_room_look(def, &box, &base, orbit, &camera, &T_world_view);
    if (rlf_map_predict(map, &camera, &T_world_view, &v->prediction) != RLF_OK) {
        return NULL;
    }
    v->sight = (rlf_room_sight){&v->prediction, rlf_map_predict_color(map), v->path, v->path_count};
    return &v->sight;
}
