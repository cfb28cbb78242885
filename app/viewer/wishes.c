/* What the user asks for by keys and mouse: views, throws, placing, pictures. */
#include "viewer/state.h"
#include "viewer/throw.h"

static void set_view(viewer *v, rlf_view view)
{
    const rlf_view views[2] = {v->is_beside ? RLF_VIEW_CAMERA : view, view};
    v->view = view;
    if (rlf_pipeline_set_views(v->pipeline, views, v->is_beside ? 2 : 1) != RLF_OK) {
        viewer_show_message(v, rlf_error_text());
    }
    v->is_redraw_due = true;
}

/* Half a turn for the window's height. */
static void turn(viewer *v, const viewer_wishes *wishes)
{
    double zoom = v->orbit.zoom > 0.0 ? v->orbit.zoom : 1.0;
    for (double step = wishes->zoom; step >= 0.5; step -= 1.0) {
        zoom *= 0.9;
    }
    for (double step = wishes->zoom; step <= -0.5; step += 1.0) {
        zoom /= 0.9;
    }
    v->orbit.yaw -= RLF_PI * wishes->turn_x;
    v->orbit.pitch = rlf_clamp(v->orbit.pitch + RLF_PI * wishes->turn_y, -1.5, 1.5);
    v->orbit.zoom = rlf_clamp(zoom, 0.1, 10.0);
    rlf_pipeline_set_orbit(v->pipeline, &v->orbit);
    v->is_redraw_due = true;
}

/* Picture pixel of a window position; false beside the picture. */
static bool pixel_at(const viewer *v, double x, double y, double *out_u, double *out_v)
{
    int32_t width;
    int32_t height;
    viewer_window_get_size(&v->window, &width, &height);
    const rlf_image_rgba8 *image = &v->frame.render.image;
    viewer_fit fit = {width, height, image->width, image->height};
    if (!v->has_frame || width < 1 || height < 1 || !viewer_fit_pick(&fit, x, y, out_u, out_v)) {
        return false;
    }
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->pipeline);
    const rlf_camera *camera = def.rig.has_color ? &def.rig.color : &def.rig.depth;
    const int32_t one_width = def.width > 0 ? def.width : camera->width;
    const int32_t one_height = def.height > 0 ? def.height : camera->height;
    *out_u -= *out_u > one_width - 0.5 ? one_width : 0; /* the next of several views */
    *out_v -= *out_v > one_height - 0.5 ? one_height : 0;
    return true;
}

static void throw_body(viewer *v, double pixel_u, double pixel_v, double drag_fraction)
{
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->pipeline);
    if (v->view == RLF_VIEW_POINTS && !v->is_beside) {
        viewer_show_message(v, "no throws in this view: B puts the camera beside it");
        return;
    }
    viewer_ray ray = viewer_ray_make(&def, &v->options->T_world_camera, pixel_u, pixel_v);
    double speed = viewer_throw_speed(drag_fraction);
    rlf_body_def body = viewer_throw_body(&ray, speed, v->thrown_count);
    rlf_body_id id;
    if (rlf_world_add_body(rlf_pipeline_get_world(v->pipeline), &body, &id) != RLF_OK) {
        viewer_show_message(v, rlf_error_text());
        return;
    }
    v->thrown_count++;
    v->is_redraw_due = true;
}

/* A click throws a cube, or picks a point of the model that is being placed. */
static void click(viewer *v, const viewer_wishes *wishes)
{
    double u, w;
    char text[VIEWER_PLACE_TEXT];
    if (!pixel_at(v, wishes->throw_x, wishes->throw_y, &u, &w)) {
        return;
    }
    if (!v->place.is_on) {
        throw_body(v, u, w, wishes->throw_drag_fraction);
        return;
    }
    viewer_place_pick(&v->place, v->pipeline, u, w, text);
    viewer_show_message(v, text);
}

static void save_scene(viewer *v)
{
    char text[VIEWER_LINE_SIZE] = "";
    int32_t count;
    const rlf_known_def *known = rlf_pipeline_get_known(v->pipeline, &count);
    if (v->options->on_scene == NULL) {
        viewer_show_message(v, "no scene file to save: start with --scene");
        return;
    }
    rlf_result result = v->options->on_scene(v->options->context, known, count, text, sizeof text);
    viewer_show_message(v, result == RLF_OK ? text : rlf_error_text());
}

/* Moves a model by a centimetre and a degree, or a tenth of that. */
static void nudge(viewer *v, const viewer_wishes *wishes)
{
    char text[VIEWER_PLACE_TEXT];
    double step = wishes->is_fine ? 0.1 : 1.0;
    rlf_vec3 shift = {wishes->nudge_x, wishes->nudge_y, wishes->nudge_z};
    viewer_place_nudge(&v->place, v->pipeline, &v->options->T_world_camera,
                       rlf_scale(shift, 0.01 * step), wishes->nudge_turn * step * RLF_PI / 180.0,
                       text);
    if (text[0] != '\0') {
        viewer_show_message(v, text);
    }
    v->is_redraw_due = true;
}

static void fulfil_place_wishes(viewer *v, const viewer_wishes *wishes)
{
    const struct {
        bool is_due;
        viewer_place_action action;
    } acts[4] = {{wishes->next_object, VIEWER_PLACE_NEXT_OBJECT},
                 {wishes->skip_point, VIEWER_PLACE_SKIP},
                 {wishes->undo_points, VIEWER_PLACE_UNDO},
                 {wishes->solve_points, VIEWER_PLACE_SOLVE}};
    char text[VIEWER_PLACE_TEXT];
    if (wishes->toggle_place) {
        if (viewer_place_toggle(&v->place, v->pipeline, text)) {
            set_view(v, v->place.is_on ? RLF_VIEW_KNOWN : RLF_VIEW_CAMERA);
        }
        viewer_show_message(v, text);
    }
    for (int i = 0; i < 4 && v->place.is_on; i++) {
        if (acts[i].is_due) {
            viewer_place_act(&v->place, v->pipeline, acts[i].action, text);
            viewer_show_message(v, text);
        }
    }
    if (wishes->nudge_x != 0 || wishes->nudge_y != 0 || wishes->nudge_z != 0 ||
        wishes->nudge_turn != 0) {
        nudge(v, wishes);
    }
    if (wishes->save_scene && v->place.is_on) {
        save_scene(v);
    }
}

/* The picture without the lines of text. */
static void save_picture(viewer *v)
{
    char text[VIEWER_LINE_SIZE] = "";
    if (v->options->on_picture == NULL || !v->has_frame) {
        viewer_show_message(v, "no place to save pictures to");
        return;
    }
    rlf_result result =
        v->options->on_picture(v->options->context, &v->frame.render.image, text, sizeof text);
    viewer_show_message(v, result == RLF_OK ? text : rlf_error_text());
}

static void toggle_record(viewer *v)
{
    char text[VIEWER_LINE_SIZE];
    if (v->options->on_record != NULL) {
        const rlf_result result = v->options->on_record(v->options->context, text, sizeof text);
        viewer_show_message(v, result == RLF_OK ? text : rlf_error_text());
    }
}

static void restart(viewer *v)
{
    if (rlf_pipeline_restart(v->pipeline) != RLF_OK) {
        viewer_show_message(v, rlf_error_text());
        return;
    }
    v->is_at_end = false;
    v->is_step_due = true; /* shows the first frame also while paused */
    v->due_ns = rlf_clock_ns();
}

void viewer_fulfil_wishes(viewer *v)
{
    viewer_wishes wishes = v->window.wishes;
    v->window.wishes = (viewer_wishes){.view = -1};
    if (wishes.toggle_pause || (wishes.step && !v->is_paused)) {
        v->is_paused = !v->is_paused;
        v->due_ns = rlf_clock_ns();
        v->last_step_ns = 0;
        v->is_redraw_due = true;
    }
    v->is_step_due = v->is_step_due || (wishes.step && !v->is_at_end);
    if (wishes.restart) {
        restart(v);
    }
    if (wishes.toggle_help) {
        v->shows_help = !v->shows_help;
        v->is_redraw_due = true;
    }
    if (wishes.view >= 0 && wishes.view < RLF_VIEW_COUNT) {
        set_view(v, (rlf_view)wishes.view);
    }
    if (wishes.next_view) {
        set_view(v, (rlf_view)((v->view + 1) % RLF_VIEW_COUNT));
    }
    if (wishes.toggle_beside) {
        v->is_beside = !v->is_beside;
        set_view(v, v->view);
    }
    if (wishes.turn_x != 0.0 || wishes.turn_y != 0.0 || wishes.zoom != 0.0) {
        turn(v, &wishes);
    }
    fulfil_place_wishes(v, &wishes);
    if (wishes.throw_body) {
        click(v, &wishes);
    }
    if (wishes.save_picture) {
        save_picture(v);
    }
    if (wishes.toggle_record) {
        toggle_record(v);
    }
    v->is_present_due = v->is_present_due || wishes.refresh;
}
