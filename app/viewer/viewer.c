/* The window's loop: frames at the source's pace, and when to draw what. */
#include "viewer/viewer.h"

#include "viewer/state.h"

#include <string.h>

#define IDLE_WAIT_S 0.05     /* longest sleep, so that Ctrl-C is noticed */
#define WINDOW_WIDTH_MIN 640 /* smaller pictures start enlarged */
#define SMOOTHING 0.1        /* of figures on screen: weight of the newest frame */

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
    if (v->options->source == NULL) {
        return;
    }
    const int32_t silent_s = (int32_t)rlf_source_get_status(v->options->source).silence_s;
    v->is_redraw_due = v->is_redraw_due || silent_s != v->silent_s;
    v->silent_s = silent_s;
}

/* The frame after `due` is one period later; a loop that has fallen behind does not race. */
static void schedule_next(viewer *v, int64_t now_ns)
{
    double fps = v->options->frames_per_second;
    int64_t period = fps > 0.0 ? (int64_t)(VIEWER_NS_PER_S / fps) : 0;
    v->due_ns = v->due_ns + period > now_ns - period ? v->due_ns + period : now_ns;
}

static rlf_result step(viewer *v)
{
    schedule_next(v, rlf_clock_ns());
    viewer_update_overlay(v);
    rlf_result result = rlf_pipeline_step(v->pipeline, &v->frame);
    if (result == RLF_NO_FRAME) {
        note_silence(v);
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
    v->silent_s = 0;
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
    viewer_update_overlay(v);
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
        wait_s = (double)(v->due_ns - rlf_clock_ns()) / VIEWER_NS_PER_S;
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
        viewer_fulfil_wishes(v);
        int64_t now = rlf_clock_ns();
        viewer_forget_old_message(v, now);
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
