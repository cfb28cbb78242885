/* One picture of the whole room, by the soft renderer. */
#include "fuse/picture.h"

#include <string.h>

static rlf_compositor_def picture_def(const fuser *f, rlf_pool *pool)
{
    rlf_compositor_def def = rlf_compositor_def_default();
    def.rig = *f->rig;
    def.grid = f->surface->camera;
    def.ray_x = f->surface->ray_x;
    def.ray_y = f->surface->ray_y;
    def.pool = pool;
    return def;
}

static rlf_result draw(const rlf_compositor_def *def, const rlf_render_input *input,
                       const char *path)
{
    rlf_compositor *compositor = NULL;
    rlf_render_output out;
    rlf_result result = rlf_compositor_create_soft(def, &compositor);
    if (result == RLF_OK) {
        result = rlf_compositor_render(compositor, input, &out);
    }
    if (result == RLF_OK) {
        result = rlf_png_write_rgba(path, &out.image);
    }
    rlf_compositor_destroy(&compositor);
    return result;
}

static rlf_result draw_way(const fuser *f, const trajectory *way, rlf_vec3 *path,
                           const rlf_orbit *orbit, rlf_pool *pool, const char *to)
{
    const rlf_compositor_def def = picture_def(f, pool);
    rlf_aabb box = rlf_map_get_status(f->map).box;
    const rlf_frame no_frame = {.sequence = 0};
    rlf_camera camera;
    rlf_pose T_world_view;
    rlf_prediction seen;
    for (int32_t i = 0; i < way->count; i++) {
        path[i] = way->found[i].p;
        rlf_aabb_extend(&box, path[i]);
    }
    rlf_room_look(&def, &box, &way->found[0], orbit, &camera, &T_world_view);
    rlf_result result = rlf_map_predict(f->map, &camera, &T_world_view, &seen);
    if (result != RLF_OK) {
        return result;
    }
    const rlf_room_sight room = {&seen, rlf_map_predict_color(f->map), path, way->count};
    const rlf_render_input input = {.frame = &no_frame,
                                    .surface = f->surface,
                                    .T_world_camera = way->found[way->count - 1],
                                    .view = RLF_VIEW_MAP,
                                    .room = &room};
    return draw(&def, &input, to);
}

rlf_result fuse_picture_write(const char *path, const fuser *f, const trajectory *way,
                              const rlf_orbit *orbit, rlf_pool *pool)
{
    rlf_vec3 *places = rlf_alloc_array((size_t)way->count, sizeof(*places));
    if (places == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_result result = draw_way(f, way, places, orbit, pool, path);
    rlf_free(places);
    return result;
}
