/* The lines of text over the picture: state, times, keys, messages. */
#include "viewer/state.h"
#include "viewer/throw.h"

#include <stdio.h>

#define MESSAGE_S 3.0 /* how long a message stays */

static const char *const help_lines[] = {
    "Space pause   N or . one frame   R restart",
    "1 camera 2 depth 3 normals 4 mesh 5 regions",
    "6 foreground 7 background 8 velocity",
    "9 thickness 0 reason O points C contacts",
    "V next view   B beside the camera",
    "right drag turns points, wheel zooms",
    "click or T: throw a cube, drag for speed",
    "P picture   E record   F full screen   H keys   Q quit",
    "K place models of real things",
};

static const char *const place_lines[] = {
    "X cannot see that point   Backspace begin again   Enter 3 are enough",
    "arrows Page [ ] move it, shift finely   Tab next one   S save   K done",
};

void viewer_show_message(viewer *v, const char *text)
{
    (void)snprintf(v->message, sizeof v->message, "%s", text);
    v->message_end_ns = rlf_clock_ns() + (int64_t)(MESSAGE_S * VIEWER_NS_PER_S);
    v->is_redraw_due = true;
}

static const char *state_text(const viewer *v)
{
    return v->is_at_end ? "  end: R restarts" : (v->is_paused ? "  paused" : "");
}

void viewer_update_overlay(viewer *v)
{
    const char *pointers[VIEWER_LINES_MAX];
    int32_t count = 0;
    int32_t bodies = v->has_frame ? v->frame.snapshot->body_count : 0;
    const rlf_stage_times *t = &v->times;
    (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "%.60s  %s  %s%s", v->options->source_name,
                   rlf_view_name(v->view), v->renderer, state_text(v));
    (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "%.1f fps  %.2f s  %d %s", v->fps,
                   v->has_frame ? v->frame.time_s : 0.0, (int)bodies,
                   bodies == 1 ? "body" : "bodies");
    (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE,
                   "ms: capture %.1f surface %.1f physics %.1f render %.1f  latency %.1f",
                   t->capture_ms, t->surface_ms, t->physics_ms, t->render_ms, v->latency_ms);
    if (v->silent_s > 0) {
        (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "no frames from %.60s for %d s",
                       v->options->source_name, (int)v->silent_s);
    }
    if (v->options->on_status != NULL &&
        v->options->on_status(v->options->context, v->lines[count], VIEWER_LINE_SIZE)) {
        count++;
    }
    double drag = viewer_window_get_drag(&v->window);
    if (drag >= 0.0) {
        (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "throw %.1f m/s",
                       viewer_throw_speed(drag));
    }
    if (v->message[0] != '\0') {
        (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "%s", v->message);
    }
    if (v->place.is_on) {
        viewer_place_hint(&v->place, v->lines[count++]);
        (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "%s", place_lines[0]);
        (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "%s", place_lines[1]);
    }
    int32_t help_count =
        v->shows_help && !v->place.is_on ? (int32_t)(sizeof help_lines / sizeof help_lines[0]) : 0;
    for (int32_t i = 0; i < help_count; i++) {
        (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "%s", help_lines[i]);
    }
    if (!v->shows_help) {
        (void)snprintf(v->lines[count++], VIEWER_LINE_SIZE, "H keys");
    }
    for (int32_t i = 0; i < count; i++) {
        pointers[i] = v->lines[i];
    }
    rlf_pipeline_set_overlay(v->pipeline, pointers, count);
}

void viewer_forget_old_message(viewer *v, int64_t now_ns)
{
    if (v->message[0] != '\0' && now_ns > v->message_end_ns) {
        v->message[0] = '\0';
        v->is_redraw_due = true;
    }
}
