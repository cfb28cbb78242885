/* What the mouse does in the picture: throws, picks bodies up, deletes them, seeks. */
#include "viewer/state.h"

#include <string.h>

/* Picture pixel of a window position; false beside the picture. */
static bool pixel_at(const viewer *v, double x, double y, double *out_u, double *out_v)
{
    int32_t width;
    int32_t height;
    viewer_get_area(v, &width, &height);
    const rlf_image_rgba8 *image = &v->frame.render.image;
    const viewer_fit fit = {width,         height,   image->width,
                            image->height, v->fills, v->corners.is_askew ? &v->corners.map : NULL};
    if (!v->has_frame || width < 1 || height < 1 || !viewer_fit_pick(&fit, x, y, out_u, out_v)) {
        return false;
    }
    *out_u = v->is_mirrored ? image->width - 1 - *out_u : *out_u;
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->stage.pipeline);
    const rlf_camera *camera = def.rig.has_color ? &def.rig.color : &def.rig.depth;
    const int32_t one_width = def.width > 0 ? def.width : camera->width;
    const int32_t one_height = def.height > 0 ? def.height : camera->height;
    *out_u -= *out_u > one_width - 0.5 ? one_width : 0; /* the next of several views */
    *out_v -= *out_v > one_height - 0.5 ? one_height : 0;
    return true;
}

/* False where there is no ray: beside the picture, and in a view from elsewhere. */
static bool ray_at(const viewer *v, double x, double y, viewer_ray *out)
{
    double pixel_u, pixel_v;
    const bool is_elsewhere = v->view == RLF_VIEW_POINTS || v->view == RLF_VIEW_MAP;
    if ((is_elsewhere && !v->is_beside) || !pixel_at(v, x, y, &pixel_u, &pixel_v)) {
        return false;
    }
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->stage.pipeline);
    const rlf_pose T_world_camera = viewer_camera(v);
    *out = viewer_ray_make(&def, &T_world_camera, pixel_u, pixel_v);
    return true;
}

void viewer_press(viewer *v, viewer_commands *commands)
{
    double share;
    viewer_ray ray;
    rlf_ray_hit hit;
    const rlf_world *world = rlf_pipeline_get_world(v->stage.pipeline);
    const bool is_up = !v->window.is_dragging; /* a click: it went up already */
    bool is_taken = viewer_press_corner(v, commands);
    if (is_taken) {
        v->corners.is_held = !is_up;
    } else if ((is_taken =
                    viewer_seek_pick(v, commands->press_x, commands->press_y, false, &share))) {
        viewer_seek_to(v, share);
        v->is_seeking = !is_up;
    } else if (!v->place.is_on && ray_at(v, commands->press_x, commands->press_y, &ray) &&
               viewer_grab_find(world, &ray, &hit)) {
        viewer_grab_begin(&v->grab, world, &ray, &hit);
        v->grab.is_on = v->grab.is_on && !is_up;
        is_taken = true;
    }
    if (is_taken) {
        commands->throw_body = false;
        v->window.is_held = !is_up;
        v->window.is_dragging = false;
    }
}

void viewer_follow_mouse(viewer *v)
{
    double x, y, share;
    viewer_ray ray;
    if (!v->window.is_held) {
        v->grab.is_on = v->is_seeking = v->corners.is_held = false;
        return;
    }
    viewer_drag_corner(v);
    viewer_window_get_cursor(&v->window, &x, &y);
    if (v->is_seeking && viewer_seek_pick(v, x, y, true, &share)) {
        viewer_seek_to(v, share);
    }
    if (v->grab.is_on && ray_at(v, x, y, &ray)) {
        v->grab.ray = ray;
    }
}

static void throw_body(viewer *v, const viewer_ray *ray, double drag_fraction)
{
    const double speed = viewer_throw_speed(drag_fraction);
    rlf_body_def body = viewer_throw_body(&v->thrown, ray, speed, v->thrown_count);
    rlf_body_id id;
    if (rlf_world_add_body(rlf_pipeline_get_world(v->stage.pipeline), &body, &id) != RLF_OK) {
        viewer_show_error(v, rlf_error_text());
        return;
    }
    v->thrown_count++;
    v->is_redraw_due = true;
}

/* A click throws a body, or picks a point of the model that is being placed. */
void viewer_click(viewer *v, const viewer_commands *commands)
{
    double u, w;
    viewer_ray ray;
    char text[VIEWER_PLACE_TEXT];
    if (!pixel_at(v, commands->throw_x, commands->throw_y, &u, &w)) {
        return;
    }
    if (v->place.is_on) {
        viewer_place_pick(&v->place, v->stage.pipeline, u, w, text);
        viewer_show_message(v, text);
    } else if (ray_at(v, commands->throw_x, commands->throw_y, &ray)) {
        throw_body(v, &ray, commands->throw_drag_fraction);
    } else {
        viewer_show_message(v, "no throws in this view: B puts the camera beside it");
    }
}

void viewer_delete(viewer *v)
{
    double x, y;
    viewer_ray ray;
    rlf_ray_hit hit;
    const rlf_world *world = rlf_pipeline_get_world(v->stage.pipeline);
    viewer_window_get_cursor(&v->window, &x, &y);
    if (!ray_at(v, x, y, &ray) || !viewer_grab_find(world, &ray, &hit)) {
        viewer_show_message(v, "no body under the mouse to delete");
        return;
    }
    viewer_remove_body(v, hit.body);
}
