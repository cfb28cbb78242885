/* The window's loop: frames at the source's pace, the user's wishes, lines of text over it. */
#include "viewer/viewer.h"

#include "viewer/place.h"
#include "viewer/throw.h"
#include "viewer/window.h"

#include "relief/gl.h"

#include <stdio.h>
#include <string.h>

#define NS_PER_S 1000000000.0
#define IDLE_WAIT_S 0.05     /* longest sleep, so that Ctrl-C is noticed */
#define MESSAGE_S 3.0        /* how long a message stays */
#define WINDOW_WIDTH_MIN 640 /* smaller pictures start enlarged */
#define OVERLAY_LINES_MAX 20 /* of text over the picture */
#define OVERLAY_LINE_SIZE 128
#define SMOOTHING 0.1 /* of figures on screen: weight of the newest frame */

typedef struct viewer {
    rlf_pipeline *pipeline;
    const viewer_options *options;
    rlf_gl_presenter *presenter;
    viewer_window window;
    const char *renderer; /* name on screen */
    rlf_pipeline_output frame;
    bool has_frame, is_paused, is_at_end, shows_help;
    bool is_step_due, is_redraw_due, is_present_due;
    rlf_view view;
    bool is_beside; /* the camera's picture is beside the view */
    rlf_orbit orbit;
    int64_t frames_done;
    int32_t thrown_count;
    viewer_place place;
    int64_t due_ns;       /* of the next frame */
    int64_t last_step_ns; /* when the last one was done; 0 = none */
    double fps;
    rlf_stage_times times; /* smoothed */
    char message[OVERLAY_LINE_SIZE];
    int64_t message_end_ns;
    char lines[OVERLAY_LINES_MAX][OVERLAY_LINE_SIZE];
} viewer;

static const char *const help_lines[] = {
    "Space pause   N or . one frame   R restart",
    "1 camera 2 depth 3 normals 4 mesh 5 regions",
    "6 foreground 7 background 8 velocity",
    "9 thickness 0 reason O points C contacts",
    "V next view   B beside the camera",
    "right drag turns points, wheel zooms",
    "click or T: throw a cube, drag for speed",
    "P picture   F full screen   H keys   Q quit",
    "K place models of real things",
};

static const char *const place_lines[] = {
    "X cannot see that point   Backspace begin again   Enter 3 are enough",
    "arrows Page [ ] move it, shift finely   Tab next one   S save   K done",
};

viewer_options viewer_options_default(void)
{
    viewer_options options = {0};
    options.title = "Relief";
    options.source_name = "";
    options.frame_count = -1;
    options.use_gl = true;
    options.show_help = true;
    options.view_count = 1;
    options.T_world_camera = rlf_pose_identity();
    return options;
}

/* ---- text over the picture ------------------------------------------------------------------ */

static void show_message(viewer *v, const char *text)
{
    (void)snprintf(v->message, sizeof v->message, "%s", text);
    v->message_end_ns = rlf_clock_ns() + (int64_t)(MESSAGE_S * NS_PER_S);
    v->is_redraw_due = true;
}

static const char *state_text(const viewer *v)
{
    return v->is_at_end ? "  end: R restarts" : (v->is_paused ? "  paused" : "");
}

static void update_overlay(viewer *v)
{
    const char *pointers[OVERLAY_LINES_MAX];
    int32_t count = 0;
    int32_t bodies = v->has_frame ? v->frame.snapshot->body_count : 0;
    const rlf_stage_times *t = &v->times;
    (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "%.60s  %s  %s%s", v->options->source_name,
                   rlf_view_name(v->view), v->renderer, state_text(v));
    (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "%.1f fps  %.2f s  %d %s", v->fps,
                   v->has_frame ? v->frame.time_s : 0.0, (int)bodies,
                   bodies == 1 ? "body" : "bodies");
    (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE,
                   "ms: capture %.1f surface %.1f physics %.1f render %.1f  latency %.1f",
                   t->capture_ms, t->surface_ms, t->physics_ms, t->render_ms,
                   t->surface_ms + t->physics_ms + t->render_ms);
    double drag = viewer_window_get_drag(&v->window);
    if (drag >= 0.0) {
        (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "throw %.1f m/s",
                       viewer_throw_speed(drag));
    }
    if (v->message[0] != '\0') {
        (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "%s", v->message);
    }
    if (v->place.is_on) {
        viewer_place_hint(&v->place, v->lines[count++]);
        (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "%s", place_lines[0]);
        (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "%s", place_lines[1]);
    }
    int32_t help_count =
        v->shows_help && !v->place.is_on ? (int32_t)(sizeof help_lines / sizeof help_lines[0]) : 0;
    for (int32_t i = 0; i < help_count; i++) {
        (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "%s", help_lines[i]);
    }
    if (!v->shows_help) {
        (void)snprintf(v->lines[count++], OVERLAY_LINE_SIZE, "H keys");
    }
    for (int32_t i = 0; i < count; i++) {
        pointers[i] = v->lines[i];
    }
    rlf_pipeline_set_overlay(v->pipeline, pointers, count);
}

static void forget_old_message(viewer *v, int64_t now_ns)
{
    if (v->message[0] != '\0' && now_ns > v->message_end_ns) {
        v->message[0] = '\0';
        v->is_redraw_due = true;
    }
}

/* ---- frames --------------------------------------------------------------------------------- */

static void smooth(double *mean, double value, bool is_first)
{
    *mean = is_first ? value : *mean + SMOOTHING * (value - *mean);
}

static void note_times(viewer *v)
{
    bool is_first = v->frames_done == 0;
    const rlf_stage_times *t = &v->frame.times;
    int64_t now = rlf_clock_ns();
    if (v->last_step_ns != 0 && now > v->last_step_ns && !v->is_paused) {
        double seconds = (double)(now - v->last_step_ns) / NS_PER_S;
        /* Averages periods, not rates: a long frame must count as long as it took. */
        double period = v->fps > 0.0 ? 1.0 / v->fps : seconds;
        smooth(&period, seconds, false);
        v->fps = 1.0 / period;
    }
    v->last_step_ns = now;
    smooth(&v->times.capture_ms, t->capture_ms, is_first);
    smooth(&v->times.surface_ms, t->surface_ms, is_first);
    smooth(&v->times.physics_ms, t->physics_ms, is_first);
    smooth(&v->times.render_ms, t->render_ms, is_first);
}

/* The frame after `due` is one period later; a loop that has fallen behind does not race. */
static void schedule_next(viewer *v, int64_t now_ns)
{
    double fps = v->options->frames_per_second;
    int64_t period = fps > 0.0 ? (int64_t)(NS_PER_S / fps) : 0;
    v->due_ns = v->due_ns + period > now_ns - period ? v->due_ns + period : now_ns;
}

static rlf_result step(viewer *v)
{
    schedule_next(v, rlf_clock_ns());
    update_overlay(v);
    rlf_result result = rlf_pipeline_step(v->pipeline, &v->frame);
    if (result == RLF_NO_FRAME) {
        return RLF_OK;
    }
    if (result == RLF_END) {
        v->is_at_end = true;
        v->is_redraw_due = v->has_frame;
        return v->has_frame ? RLF_OK
                            : rlf_fail(RLF_ERROR_IO,
                                       "%s: has no frame with depth; check its "
                                       "depth.txt",
                                       v->options->source_name);
    }
    if (result != RLF_OK) {
        return result;
    }
    v->has_frame = true;
    v->is_step_due = false;
    v->is_redraw_due = false;
    v->is_present_due = true;
    note_times(v);
    v->frames_done++;
    return v->options->on_frame != NULL ? v->options->on_frame(v->options->context, &v->frame)
                                        : RLF_OK;
}

static rlf_result redraw(viewer *v)
{
    update_overlay(v);
    v->is_redraw_due = false;
    v->is_present_due = true;
    return rlf_pipeline_redraw(v->pipeline, &v->frame);
}

static void present(viewer *v)
{
    int32_t width;
    int32_t height;
    viewer_window_get_framebuffer_size(&v->window, &width, &height);
    v->is_present_due = false;
    if (width > 0 && height > 0 && v->frame.render.image.data != NULL) {
        viewer_place_draw(&v->place, &v->frame.render.image);
        rlf_gl_presenter_draw(v->presenter, &v->frame.render.image, width, height);
        viewer_window_swap(&v->window);
    }
}

/* ---- wishes --------------------------------------------------------------------------------- */

static void set_view(viewer *v, rlf_view view)
{
    const rlf_view views[2] = {v->is_beside ? RLF_VIEW_CAMERA : view, view};
    v->view = view;
    if (rlf_pipeline_set_views(v->pipeline, views, v->is_beside ? 2 : 1) != RLF_OK) {
        show_message(v, rlf_error_text());
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
        show_message(v, "no throws in this view: B puts the camera beside it");
        return;
    }
    viewer_ray ray = viewer_ray_make(&def, &v->options->T_world_camera, pixel_u, pixel_v);
    double speed = viewer_throw_speed(drag_fraction);
    rlf_body_def body = viewer_throw_body(&ray, speed, v->thrown_count);
    rlf_body_id id;
    if (rlf_world_add_body(rlf_pipeline_get_world(v->pipeline), &body, &id) != RLF_OK) {
        show_message(v, rlf_error_text());
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
    show_message(v, text);
}

static void save_scene(viewer *v)
{
    char text[OVERLAY_LINE_SIZE] = "";
    int32_t count;
    const rlf_known_def *known = rlf_pipeline_get_known(v->pipeline, &count);
    if (v->options->on_scene == NULL) {
        show_message(v, "no scene file to save: start with --scene");
        return;
    }
    rlf_result result = v->options->on_scene(v->options->context, known, count, text, sizeof text);
    show_message(v, result == RLF_OK ? text : rlf_error_text());
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
        show_message(v, text);
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
        show_message(v, text);
    }
    for (int i = 0; i < 4 && v->place.is_on; i++) {
        if (acts[i].is_due) {
            viewer_place_act(&v->place, v->pipeline, acts[i].action, text);
            show_message(v, text);
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
    char text[OVERLAY_LINE_SIZE] = "";
    if (v->options->on_picture == NULL || !v->has_frame) {
        show_message(v, "no place to save pictures to");
        return;
    }
    rlf_result result =
        v->options->on_picture(v->options->context, &v->frame.render.image, text, sizeof text);
    show_message(v, result == RLF_OK ? text : rlf_error_text());
}

static void restart(viewer *v)
{
    if (rlf_pipeline_restart(v->pipeline) != RLF_OK) {
        show_message(v, rlf_error_text());
        return;
    }
    v->is_at_end = false;
    v->is_step_due = true; /* shows the first frame also while paused */
    v->due_ns = rlf_clock_ns();
}

static void fulfil_wishes(viewer *v)
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
    v->is_present_due = v->is_present_due || wishes.refresh;
}

/* ---- loop ----------------------------------------------------------------------------------- */

static bool is_done(const viewer *v)
{
    const viewer_options *o = v->options;
    return viewer_window_should_close(&v->window) ||
           (o->interrupted != NULL && *o->interrupted != 0) ||
           (o->frame_count >= 0 && v->frames_done >= o->frame_count);
}

/* Sleeps until the next frame is due or something happens. */
static void wait_for_events(viewer *v, bool is_playing)
{
    double wait_s = IDLE_WAIT_S;
    if (v->is_step_due || v->is_redraw_due || v->is_present_due) {
        wait_s = 0.0;
    } else if (is_playing) {
        wait_s = (double)(v->due_ns - rlf_clock_ns()) / NS_PER_S;
        wait_s = wait_s < IDLE_WAIT_S ? wait_s : IDLE_WAIT_S;
    }
    viewer_window_poll(&v->window, wait_s);
}

static rlf_result run_loop(viewer *v)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK && !is_done(v)) {
        bool is_playing = !v->is_paused && !v->is_at_end;
        wait_for_events(v, is_playing);
        fulfil_wishes(v);
        int64_t now = rlf_clock_ns();
        forget_old_message(v, now);
        is_playing = !v->is_paused && !v->is_at_end;
        if (v->is_step_due || (is_playing && now >= v->due_ns)) {
            result = step(v);
        } else if (v->window.is_dragging && !is_playing && v->has_frame) {
            v->is_redraw_due = true; /* the speed of the throw changes with the mouse */
        }
        if (result == RLF_OK && v->is_redraw_due && v->has_frame) {
            result = redraw(v);
        }
        if (result == RLF_OK && v->is_present_due) {
            present(v);
        }
    }
    return result;
}

static void choose_renderer(viewer *v)
{
    const viewer_options *o = v->options;
    v->renderer = "soft";
    if (!o->use_gl || (o->avoid_software_gl && viewer_window_is_software_gl(&v->window))) {
        return;
    }
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->pipeline);
    rlf_compositor *compositor = NULL;
    rlf_result result = rlf_gl_compositor_create(&def, true, &compositor);
    if (result == RLF_OK) {
        result = rlf_pipeline_set_compositor(v->pipeline, compositor);
    }
    if (result == RLF_OK) {
        v->renderer = "gl";
    } else {
        rlf_log(RLF_LOG_WARNING, "%s; going on with the soft renderer", rlf_error_text());
    }
}

rlf_result viewer_run(rlf_pipeline *pipeline, const viewer_options *options)
{
    viewer v;
    memset(&v, 0, sizeof v);
    v.pipeline = pipeline;
    v.options = options;
    v.shows_help = options->show_help;
    v.view = options->views[options->view_count > 1 ? options->view_count - 1 : 0];
    v.is_beside = options->view_count == 2 && options->views[0] == RLF_VIEW_CAMERA;
    v.orbit = options->orbit;
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(pipeline);
    const rlf_camera *camera = def.rig.has_color ? &def.rig.color : &def.rig.depth;
    int32_t width = def.width > 0 ? def.width : camera->width;
    int32_t height = def.height > 0 ? def.height : camera->height;
    while (width < WINDOW_WIDTH_MIN) {
        width *= 2;
        height *= 2;
    }
    rlf_result result = viewer_window_open(options->title, width, height, &v.window);
    if (result != RLF_OK) {
        return result;
    }
    result = rlf_gl_presenter_create(&v.presenter);
    if (result == RLF_OK) {
        choose_renderer(&v);
        rlf_pipeline_set_plot(pipeline, true);
        v.due_ns = rlf_clock_ns();
        result = run_loop(&v);
        /* The GL renderer lives in the window's context and must go before it. */
        rlf_result soft_result = rlf_pipeline_set_compositor(pipeline, NULL);
        result = result == RLF_OK ? soft_result : result;
    }
    rlf_gl_presenter_destroy(&v.presenter);
    viewer_window_close(&v.window);
    return result;
}
