/* One picture of the whole room, by the soft renderer. */
#include "fuse/picture.h"

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

rlf_result fuse_picture_write(const char *path, const fuser *f, room_view *view,
                              const rlf_orbit *orbit, rlf_pool *pool)
{
    const rlf_compositor_def def = picture_def(f, pool);
    const rlf_frame no_frame = {.sequence = 0};
    const rlf_render_input input = {.frame = &no_frame,
                                    .surface = f->surface,
                                    .T_world_camera = view->T_world_last,
                                    .view = RLF_VIEW_MAP,
                                    .room = room_view_look(view, f->map, &def, orbit)};
    return draw(&def, &input, path);
}
