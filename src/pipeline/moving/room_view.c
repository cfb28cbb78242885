/* Where the camera has been, and the room from an orbit. */
#include "pipeline/moving/room_view.h"

#define PATH_STEP_M 0.01 /* at first; less is noise */

#define EVERY 8 /* pixel of a surface tells how far away it is */

/* Mean of a surface's depths: few that are wrong hardly count. 0 = there is none. */
static double mean_depth(const rlf_surface *s)
{
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t y = 0; y < s->height; y += EVERY) {
        for (int32_t x = 0; x < s->width; x += EVERY) {
            const float z = s->depth[y * s->width + x];
            sum += z > 0.0f ? (double)z : 0.0;
            count += z > 0.0f;
        }
    }
    return count > 0 ? sum / count : 0.0;
}

/* By the picture's corners at that depth. */
static void widen_box(room_view *v, const rlf_pose *T_world_camera, const rlf_surface *s)
{
    const double z = mean_depth(s);
    const rlf_camera *k = &s->camera;
    rlf_aabb_extend(&v->box, T_world_camera->p);
    for (int i = 0; i < 4; i++) {
        const double u = i % 2 == 0 ? 0.0 : k->width, w = i < 2 ? 0.0 : k->height;
        const rlf_vec3 p = {z * (u - k->cx) / k->fx, z * (w - k->cy) / k->fy, z};
        rlf_aabb_extend(&v->box, rlf_transform(T_world_camera, p));
    }
}

/* Every second position leaves. */
static void thin_path(room_view *v)
{
    for (int32_t i = 0; i < ROOM_VIEW_PATH / 2; i++) {
        v->path[i] = v->path[2 * i];
    }
    v->path_count = ROOM_VIEW_PATH / 2;
    v->path_step_m *= 2.0;
}

void room_view_pass(room_view *v, const rlf_pose *T_world_camera, const rlf_surface *surface)
{
    if (v->path_count == 0) {
        v->T_world_first = *T_world_camera;
        v->path_step_m = PATH_STEP_M;
        v->box = rlf_aabb_empty();
    }
    v->T_world_last = *T_world_camera;
    widen_box(v, T_world_camera, surface);
    if (v->path_count > 0) {
        const rlf_vec3 way = rlf_sub(T_world_camera->p, v->path[v->path_count - 1]);
        if (rlf_dot(way, way) < v->path_step_m * v->path_step_m) {
            return;
        }
    }
    if (v->path_count == ROOM_VIEW_PATH) {
        thin_path(v);
    }
    v->path[v->path_count++] = T_world_camera->p;
}

const rlf_room_sight *room_view_look(room_view *v, rlf_map *map, const rlf_compositor_def *def,
                                     const rlf_orbit *orbit)
{
    if (map == NULL || v->path_count == 0 || rlf_map_get_status(map).block_count == 0) {
        return NULL;
    }
    rlf_camera camera;
    rlf_pose T_world_view;
    rlf_room_look(def, &v->box, &v->T_world_first, orbit, &camera, &T_world_view);
    if (rlf_map_predict(map, &camera, &T_world_view, &v->prediction) != RLF_OK) {
        return NULL;
    }
    v->sight = (rlf_room_sight){&v->prediction, rlf_map_predict_color(map), v->path, v->path_count};
    return &v->sight;
}
