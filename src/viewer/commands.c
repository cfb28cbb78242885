/* What the user asks for by keys: views, placing, pictures, playing. */
#include "viewer/state.h"

#include <stdio.h>

/* Half a turn for the window's height. */
static void turn(viewer *v, const viewer_commands *commands)
{
    double zoom = v->orbit.zoom > 0.0 ? v->orbit.zoom : 1.0;
    for (double step = commands->zoom; step >= 0.5; step -= 1.0) {
        zoom *= 0.9;
    }
    for (double step = commands->zoom; step <= -0.5; step += 1.0) {
        zoom /= 0.9;
    }
    v->orbit.yaw -= RLF_PI * commands->turn_x;
    v->orbit.pitch = rlf_clamp(v->orbit.pitch + RLF_PI * commands->turn_y, -1.5, 1.5);
    v->orbit.zoom = rlf_clamp(zoom, 0.1, 10.0);
    rlf_pipeline_set_orbit(v->stage.pipeline, &v->orbit);
    v->is_redraw_due = true;
}

static void save_scene(viewer *v)
{
    char text[VIEWER_LINE_SIZE] = "";
    int32_t count;
    const rlf_known_def *known = rlf_pipeline_get_known(v->stage.pipeline, &count);
    if (v->options->on_scene == NULL) {
        viewer_show_error(v, "no scene file to save: start with --scene");
        return;
    }
    rlf_result result = v->options->on_scene(v->options->context, known, count, text, sizeof text);
    viewer_show_result(v, result, text);
}

/* Moves a model by a centimetre and a degree, or a tenth of that. */
static void nudge(viewer *v, const viewer_commands *commands)
{
    char text[VIEWER_PLACE_TEXT];
    double step = commands->is_fine ? 0.1 : 1.0;
    rlf_vec3 shift = {commands->nudge_x, commands->nudge_y, commands->nudge_z};
    const rlf_pose T_world_camera = viewer_camera(v);
    viewer_place_nudge(&v->place, v->stage.pipeline, &T_world_camera, rlf_scale(shift, 0.01 * step),
                       commands->nudge_turn * step * RLF_PI / 180.0, text);
    if (text[0] != '\0') {
        viewer_show_message(v, text);
    }
    v->is_redraw_due = true;
}

static void toggle_place(viewer *v)
{
    char text[VIEWER_PLACE_TEXT];
    viewer_draw_whole(v); /* points are picked in the camera's own pixels */
    if (viewer_place_toggle(&v->place, v->stage.pipeline, text)) {
        viewer_set_view(v, v->place.is_on ? RLF_VIEW_KNOWN : RLF_VIEW_CAMERA);
    }
    viewer_show_message(v, text);
}

static void run_place_commands(viewer *v, const viewer_commands *commands)
{
    const struct {
        bool is_due;
        viewer_place_action action;
    } acts[4] = {{commands->next_object, VIEWER_PLACE_NEXT_OBJECT},
                 {commands->skip_point, VIEWER_PLACE_SKIP},
                 {commands->undo_points, VIEWER_PLACE_UNDO},
                 {commands->solve_points, VIEWER_PLACE_SOLVE}};
    char text[VIEWER_PLACE_TEXT];
    if (commands->toggle_place) {
        toggle_place(v);
    }
    for (int i = 0; i < 4 && v->place.is_on; i++) {
        if (acts[i].is_due) {
            viewer_place_act(&v->place, v->stage.pipeline, acts[i].action, text);
            viewer_show_message(v, text);
        }
    }
    if (commands->nudge_x != 0 || commands->nudge_y != 0 || commands->nudge_z != 0 ||
        commands->nudge_turn != 0) {
        nudge(v, commands);
    }
    if (commands->save_scene && v->place.is_on) {
        save_scene(v);
    }
}

static void next_shape(viewer *v)
{
    const int kinds = v->thrown.model[0] != '\0' ? VIEWER_THROW_KINDS : VIEWER_THROW_MODEL;
    char text[VIEWER_LINE_SIZE];
    v->thrown.kind = (viewer_throw_kind)((int)(v->thrown.kind + 1) % kinds);
    (void)snprintf(text, sizeof text, "click throws a %s", viewer_throw_name(v->thrown.kind));
    viewer_show_message(v, text);
}

/* Arrows go a second back or on, where no model is placed. */
static void seek_by(viewer *v, int32_t seconds)
{
    const rlf_playback *p = v->stage.playback;
    const double rate = v->stage.frames_per_second > 0.0 ? v->stage.frames_per_second : 30.0;
    const int64_t count = p != NULL ? rlf_playback_get_count(p) : -1;
    if (count > 1) {
        const double frame = (double)rlf_playback_get_index(p) + seconds * rate;
        viewer_seek_to(v, frame / (double)(count - 1));
    }
}

static void toggle_overlay(viewer *v)
{
    bool *shown = viewer_screen_is_full(&v->window) ? &v->shows_overlay_in_full : &v->shows_overlay;
    *shown = !*shown;
}

/* Escape leaves one thing at a time: placing, full screen, the program. */
static void leave(viewer *v)
{
    if (v->place.is_on) {
        toggle_place(v);
    } else if (v->corners.is_on) {
        viewer_toggle_corners(v);
    } else {
        viewer_window_leave(&v->window);
    }
}

static void run_switches(viewer *v, const viewer_commands *commands)
{
    if (commands->toggle_overlay) {
        toggle_overlay(v);
    }
    v->is_mirrored = v->is_mirrored != commands->toggle_mirror;
    v->shows_panel = v->shows_panel != commands->toggle_panel;
    v->shows_help = v->shows_help != commands->toggle_help;
    if (commands->toggle_fill) {
        viewer_toggle_fill(v);
    }
    if (commands->toggle_panel && v->panel == NULL) {
        viewer_show_error(v, viewer_panel_is_built()
                                 ? "no panel here: it needs OpenGL 3.3, and this display has ES"
                                 : "this build has no panel: " VIEWER_GET_PANEL);
    }
    if (commands->open_files && v->window.panel_width > 0) {
        viewer_panel_open_files(v->panel);
    } else if (commands->open_files) {
        viewer_show_message(v,
                            "the list of files is the panel's: M brings it, or drop a file here");
    }
    if (commands->next_end && v->stage.playback != NULL) {
        viewer_set_end(v,
                       (rlf_playback_end)((int)(rlf_playback_get_end(v->stage.playback) + 1) % 3));
    }
    if (commands->next_shape) {
        next_shape(v);
    }
    if (commands->leave) {
        leave(v);
    }
    if (commands->is_screen_lost) {
        viewer_show_message(v, "the monitor is gone: the window is here again");
    }
    v->is_present_due = v->is_present_due || commands->refresh;
    v->extra_presents =
        commands->refresh && v->shows_panel && v->panel != NULL ? 2 : v->extra_presents;
}

static void run_views(viewer *v, const viewer_commands *commands)
{
    if (commands->view >= 0 && commands->view < RLF_VIEW_COUNT) {
        viewer_set_view(v, (rlf_view)commands->view);
    }
    if (commands->next_view) {
        viewer_set_view(v, (rlf_view)((v->view + 1) % RLF_VIEW_COUNT));
    }
    if (commands->toggle_beside) {
        v->is_beside = !v->is_beside;
        viewer_set_view(v, v->view);
    }
    if (v->grab.is_on && commands->zoom != 0.0) {
        viewer_grab_reach(&v->grab, commands->zoom);
    } else if (commands->turn_x != 0.0 || commands->turn_y != 0.0 || commands->zoom != 0.0) {
        turn(v, commands);
    }
}

static void run_playing(viewer *v, const viewer_commands *commands)
{
    if (commands->toggle_pause || (commands->step && !v->is_paused)) {
        viewer_toggle_pause(v);
    }
    v->is_step_due = v->is_step_due || (commands->step && !v->is_at_end);
    if (commands->restart) {
        viewer_restart(v);
    }
    if (!v->place.is_on && !v->corners.is_on && commands->nudge_x != 0) {
        seek_by(v, commands->nudge_x);
    }
}

void viewer_run_commands(viewer *v)
{
    viewer_commands commands = v->window.commands;
    v->window.commands = (viewer_commands){.view = -1};
    run_switches(v, &commands);
    run_playing(v, &commands);
    run_views(v, &commands);
    if (v->corners.is_on || commands.toggle_corners) {
        viewer_run_corners(v, &commands);
    } else {
        run_place_commands(v, &commands);
    }
    if (commands.press) {
        viewer_press(v, &commands);
    }
    viewer_follow_mouse(v);
    if (commands.throw_body) {
        viewer_click(v, &commands);
    }
    if (commands.delete_body) {
        viewer_delete(v);
    }
    if (commands.bring_back) {
        viewer_bring_back(v);
    }
    if (commands.save_picture || (commands.save_scene && !v->place.is_on)) {
        viewer_save_picture(v);
    }
    if (commands.toggle_record) {
        viewer_toggle_record(v);
    }
    if (commands.has_drop) {
        viewer_open_path(v, commands.drop);
    }
}
