/* The window's loop: frames at the source's pace, and when to draw what. */
#include "relief/window.h"

#include "viewer/state.h"

#include <string.h>

#define IDLE_WAIT_S 0.05     /* longest sleep, so that Ctrl-C is noticed */
#define WINDOW_WIDTH_MIN 960 /* smaller pictures start enlarged */
#define GAP_S (1.0 / 30.0)   /* between frames, before two are known */
#define GAP_MAX_S 0.25
#define HINT_NS 15000000000 /* three lines are read three times, and the room is looked at */
#define SMOOTHING 0.1       /* of figures on screen: weight of the newest frame */

rlf_window_def rlf_window_def_default(void)
{
    rlf_window_def options = {0};
    options.title = "Relief";
    options.stage.source_name = "";
    options.stage.scene_name = "";
    options.frame_count = -1;
    options.use_gl = true;
    options.show_help = true;
    options.view_count = 1;
    options.T_world_camera = rlf_pose_identity();
    return options;
}

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
        double seconds = (double)(now - v->last_step_ns) / VIEWER_NS_PER_S;
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
    const double computed_ms = t->surface_ms + t->physics_ms + t->render_ms;
    smooth(&v->latency_ms, v->frame.latency_ms > 0.0 ? v->frame.latency_ms : computed_ms, is_first);
}

/* The line over the picture counts the seconds without a frame. */
static void note_silence(viewer *v)
{
    if (v->stage.source == NULL) {
        return;
    }
    const int32_t silent_s = (int32_t)rlf_source_get_status(v->stage.source).silence_s;
    v->is_redraw_due = v->is_redraw_due || silent_s != v->silent_s;
    v->silent_s = silent_s;
    viewer_kiosk_note_silence(v);
}

/* The frame after `due` is one period later; a loop that has fallen behind does not race. */
static void schedule_next(viewer *v, int64_t now_ns)
{
    double fps = v->stage.frames_per_second;
    int64_t period = fps > 0.0 ? (int64_t)(VIEWER_NS_PER_S / fps) : 0;
    v->due_ns = v->due_ns + period > now_ns - period ? v->due_ns + period : now_ns;
}

/* What bodies were advanced by is what the next frame will advance them by, as far as one knows.
 * A gap says nothing of the next one. */
static void note_gap(viewer *v, int64_t before_ns)
{
    const double gap_s = (double)(v->frame.frame.time_ns - before_ns) / VIEWER_NS_PER_S;
    if (v->has_frame && gap_s > 0.0 && gap_s < GAP_MAX_S) {
        v->gap_s = gap_s;
    }
}

/* The next frame, of the source or of the program's own camera, through the pipeline. */
static rlf_result advance(viewer *v)
{
    const rlf_window_def *o = v->options;
    rlf_frame frame = {0};
    if (o->next == NULL) {
        return rlf_pipeline_step(v->stage.pipeline, &v->frame);
    }
    const rlf_result result = o->next(o->context, &frame);
    return result == RLF_OK ? rlf_pipeline_push(v->stage.pipeline, &frame, &v->frame) : result;
}

static rlf_result step(viewer *v)
{
    schedule_next(v, rlf_clock_ns());
    viewer_grab_pull(&v->grab, rlf_pipeline_get_world(v->stage.pipeline), v->gap_s);
    const int64_t before_ns = v->frame.frame.time_ns;
    rlf_result result = advance(v);
    if (result == RLF_NO_FRAME) {
        note_silence(v);
        return RLF_OK;
    }
    if (result == RLF_END && viewer_kiosk_is_on(v)) {
        return rlf_fail(RLF_END, "%s has ended", v->stage.source_name);
    }
    if (result == RLF_END) {
        v->is_at_end = true;
        v->is_step_due = false;
        v->is_present_due = v->has_frame;
        return v->has_frame ? RLF_OK
                            : rlf_fail(RLF_ERROR_IO,
                                       "%s: has no frame with depth; check its "
                                       "depth.txt",
                                       v->stage.source_name);
    }
    if (result != RLF_OK) {
        return result;
    }
    note_gap(v, before_ns);
    v->has_frame = true;
    v->silent_s = v->kiosk.silent_limit_s = 0;
    v->is_step_due = false;
    v->is_redraw_due = false;
    v->is_present_due = true;
    note_times(v);
    viewer_note_plot(v);
    v->frames_done++;
    viewer_record_frame(v);
    result = v->options->on_frame != NULL ? v->options->on_frame(v->options->context, &v->frame)
                                          : RLF_OK;
    viewer_keep_pace(v);
    return result;
}

static rlf_result redraw(viewer *v)
{
    v->is_redraw_due = false;
    v->is_present_due = true;
    return rlf_pipeline_redraw(v->stage.pipeline, &v->frame);
}

static void measure_panel(viewer *v)
{
    const bool is_wanted = v->shows_panel && !viewer_screen_is_full(&v->window);
    v->window.panel_width = is_wanted ? viewer_panel_get_width(v->panel) : 0;
}

static void draw_panel(viewer *v)
{
    const bool is_shown = v->window.panel_width > 0;
    v->window.follows_mouse = is_shown;
    if (!is_shown) {
        v->window.is_list_open = v->window.is_key_taken = false;
    }
    if (v->panel == NULL || (!is_shown && v->line_count == 0)) {
        return;
    }
    const int64_t before = rlf_clock_ns();
    viewer_panel_draw(v->panel);
    const double ms = 1e-6 * (double)(rlf_clock_ns() - before);
    smooth(&v->panel_ms, ms, v->panel_ms == 0.0);
    if (v->options->on_panel_ms != NULL) {
        v->options->on_panel_ms(v->options->context, ms);
    }
}

static void present(viewer *v)
{
    int32_t width, height, window_width, window_height, area_width;
    viewer_window_get_framebuffer_size(&v->window, &width, &height);
    viewer_window_get_size(&v->window, &window_width, &window_height);
    viewer_get_area(v, &area_width, &window_height);
    v->is_present_due = v->extra_presents > 0;
    v->extra_presents -= v->extra_presents > 0 ? 1 : 0;
    if (width < 1 || height < 1 || window_width < 1 || v->frame.render.image.data == NULL) {
        return;
    }
    const int64_t before = rlf_clock_ns();
    const int32_t shown = (int32_t)((int64_t)width * area_width / window_width);
    viewer_place_draw(&v->place, &v->frame.render.image);
    rlf_gl_presenter_set_mirror(v->presenter, v->is_mirrored);
    rlf_gl_presenter_set_place(v->presenter, v->fills,
                               v->corners.is_askew ? &v->corners.map : NULL);
    rlf_gl_presenter_draw(v->presenter, &v->frame.render.image, shown, height);
    smooth(&v->present_ms, 1e-6 * (double)(rlf_clock_ns() - before), v->present_ms == 0.0);
    viewer_draw_overlay(v, shown, height);
    viewer_draw_corners(v, shown, height);
    draw_panel(v);
    viewer_window_swap(&v->window);
}

static bool is_done(const viewer *v)
{
    const rlf_window_def *o = v->options;
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
        wait_s = (double)(v->due_ns - rlf_clock_ns()) / VIEWER_NS_PER_S;
        wait_s = wait_s < IDLE_WAIT_S ? wait_s : IDLE_WAIT_S;
    }
    viewer_window_poll(&v->window, wait_s);
}

static bool is_playing_now(const viewer *v)
{
    return !v->is_paused && !v->is_at_end && !v->kiosk.is_lost;
}

static rlf_result run_loop(viewer *v)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK && !is_done(v)) {
        bool is_playing = is_playing_now(v);
        wait_for_events(v, is_playing);
        measure_panel(v);
        viewer_run_commands(v);
        measure_panel(v);
        int64_t now = rlf_clock_ns();
        viewer_end_old_messages(v, now);
        viewer_screen_settle(&v->window, now);
        viewer_kiosk_try(v, now);
        is_playing = is_playing_now(v);
        if (v->is_step_due || (is_playing && now >= v->due_ns)) {
            result = step(v);
            if (result != RLF_OK && viewer_kiosk_is_on(v)) {
                viewer_kiosk_lose(v, rlf_error_text());
                result = RLF_OK;
            }
        } else if (v->window.is_dragging && !is_playing && v->has_frame) {
            v->is_present_due = true; /* the speed of the throw changes with the mouse */
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

/* The picture's size, and room for the panel. */
static viewer_window_size first_size(const viewer *v)
{
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->stage.pipeline);
    const rlf_camera *camera = def.rig.has_color ? &def.rig.color : &def.rig.depth;
    viewer_window_size size = {.width = def.width > 0 ? def.width : camera->width,
                               .height = def.height > 0 ? def.height : camera->height};
    while (size.width < WINDOW_WIDTH_MIN) {
        size.width *= 2;
        size.height *= 2;
    }
    if (v->shows_panel && viewer_panel_is_built()) {
        size.panel_width = VIEWER_PANEL_WIDTH;
        size.panel_height = VIEWER_PANEL_HEIGHT;
    }
    return size;
}

static void begin(viewer *v, rlf_pipeline *pipeline, const rlf_window_def *options)
{
    memset(v, 0, sizeof *v);
    v->stage = options->stage;
    v->stage.pipeline = pipeline;
    v->options = options;
    v->shows_overlay = !options->hides_overlay;
    v->shows_overlay_in_full = options->overlay_everywhere;
    v->shows_panel = !options->hides_panel;
    v->hint_end_ns = options->show_help ? rlf_clock_ns() + HINT_NS : 0;
    v->is_light = options->has_light_panel;
    v->is_mirrored = options->is_mirrored;
    v->fills = options->fills;
    viewer_corners_load(&v->corners, options->corners_path);
    v->view = options->views[options->view_count > 1 ? options->view_count - 1 : 0];
    v->is_beside = options->view_count == 2 && options->views[0] == RLF_VIEW_CAMERA;
    v->orbit = options->orbit;
    v->thrown = viewer_throw_def_default();
    v->gap_s = GAP_S;
}

static rlf_result run_in_window(viewer *v)
{
    v->window.is_kiosk = v->options->is_kiosk;
    rlf_result result = viewer_screen_choose(&v->window, v->options->monitor);
    if (result == RLF_OK && (v->options->is_fullscreen || v->options->is_kiosk)) {
        viewer_screen_toggle(&v->window);
    }
    if (result == RLF_OK) {
        result = rlf_gl_presenter_create(&v->presenter);
    }
    if (result != RLF_OK) {
        return result;
    }
    v->panel = viewer_panel_create(v);
    viewer_screen_watch(&v->window); /* imgui has put its own, empty callback in its place */
    viewer_choose_renderer(v);
    v->due_ns = rlf_clock_ns();
    result = run_loop(v);
    viewer_end_recording(v);
    viewer_panel_destroy(&v->panel);
    /* The GL renderer lives in the window's context and must go before it. */
    rlf_result soft_result = rlf_pipeline_set_compositor(v->stage.pipeline, NULL);
    return result == RLF_OK ? soft_result : result;
}

rlf_result rlf_window_run(rlf_pipeline *pipeline, const rlf_window_def *options)
{
    static viewer v; /* large: all lines */
    if (!RLF_ASSERT(pipeline != NULL && options != NULL)) {
        return rlf_fail(RLF_ERROR_INVALID, "rlf_window_run: NULL");
    }
    begin(&v, pipeline, options);
    const viewer_window_size size = first_size(&v);
    rlf_result result = viewer_window_open(options->title, &size, &v.window);
    if (result == RLF_OK) {
        result = run_in_window(&v);
        rlf_gl_presenter_destroy(&v.presenter);
        viewer_window_close(&v.window);
    }
    rlf_free(v.text.data);
    rlf_free(v.marks.data);
    return result;
}
