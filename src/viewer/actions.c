/* What keys, mouse and panel may all ask for. */
#include "viewer/state.h"

#include <stdio.h>

void viewer_choose_renderer(viewer *v)
{
    const rlf_window_def *o = v->options;
    v->renderer = "soft";
    if (!o->use_gl || (o->avoid_software_gl && viewer_window_is_software_gl(&v->window))) {
        return;
    }
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->stage.pipeline);
    rlf_compositor *compositor = NULL;
    rlf_result result = rlf_gl_compositor_create(&def, true, &compositor);
    if (result == RLF_OK) {
        result = rlf_pipeline_set_compositor(v->stage.pipeline, compositor);
    }
    if (result == RLF_OK) {
        v->renderer = "gl";
    } else {
        rlf_log(RLF_LOG_WARNING, "%s; going on with the soft renderer", rlf_error_text());
    }
}

void viewer_set_view(viewer *v, rlf_view view)
{
    if (v->options->keeps_view && view != v->view) {
        viewer_show_message(v, "the view stays: this window is a projector's");
        return;
    }
    const rlf_view views[2] = {v->is_beside ? RLF_VIEW_CAMERA : view, view};
    v->view = view;
    if (rlf_pipeline_set_views(v->stage.pipeline, views, v->is_beside ? 2 : 1) != RLF_OK) {
        viewer_show_error(v, rlf_error_text());
    }
    v->is_redraw_due = true;
}

void viewer_restart(viewer *v)
{
    if (v->kiosk.is_lost) {
        v->kiosk.again_ns = 0;
        return;
    }
    if (rlf_pipeline_restart(v->stage.pipeline) != RLF_OK) {
        viewer_show_error(v, rlf_error_text());
        return;
    }
    v->is_at_end = false;
    v->is_step_due = true; /* shows the first frame also while paused */
    v->due_ns = rlf_clock_ns();
}

void viewer_toggle_pause(viewer *v)
{
    v->is_paused = !v->is_paused;
    v->due_ns = rlf_clock_ns();
    v->last_step_ns = 0;
    v->is_present_due = true;
}

void viewer_set_end(viewer *v, rlf_playback_end end)
{
    char text[VIEWER_LINE_SIZE];
    if (v->stage.playback == NULL) {
        viewer_show_message(v, "a camera has no end");
        return;
    }
    rlf_playback_set_end(v->stage.playback, end);
    v->is_at_end = false;
    (void)snprintf(text, sizeof text, "at the end: %s", rlf_playback_name(end));
    viewer_show_message(v, text);
}

void viewer_seek_to(viewer *v, double share)
{
    rlf_playback *p = v->stage.playback;
    const int64_t count = p != NULL ? rlf_playback_get_count(p) : -1;
    if (count < 2) {
        viewer_show_message(v, "this source has no other places to go to");
        return;
    }
    const int64_t index = (int64_t)(rlf_clamp(share, 0.0, 1.0) * (double)(count - 1) + 0.5);
    if (index == rlf_playback_get_index(p)) {
        return;
    }
    if (rlf_playback_seek(p, index) != RLF_OK) {
        viewer_show_error(v, rlf_error_text());
        return;
    }
    v->is_at_end = false;
    v->is_step_due = true; /* shows it also while paused */
}
