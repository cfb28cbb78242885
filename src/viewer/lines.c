/* The lines of text over the picture. Those that come and go are below those that stay. */
#include "viewer/state.h"
#include "viewer/mouse.h"

#include <stdio.h>
#include <string.h>

static const char *const help_lines[] = {
    "Space pause   N or . one frame   R restart   L at the end",
    "arrows or the bar below: another place in the recording",
    "1 camera 2 depth 3 normals 4 mesh 5 regions",
    "6 foreground 7 background 8 velocity",
    "9 thickness 0 reason O points C contacts",
    "V next view   B beside the camera   Y mirror",
    "right drag turns points and map, wheel zooms",
    "click or T: throw, drag for speed   G another shape",
    "drag a body: pick it up   Delete: the one under the mouse   U brings it back",
    "Ctrl and O, or drop: a recording, a scene or a model",
    "S or P picture   E record   F full screen   Esc leaves it   Q quit",
    "A bodies alone   W fill the window   D drag the picture's corners",
    "H keys and figures   I all text   M panel   K place models of real things",
};

static const char *const place_lines[] = {
    "X cannot see that point   Backspace begin again   Enter 3 are enough",
    "arrows Page [ ] move it, shift finely   Tab next one   S save   K done",
};

static const char *const corner_lines[] = {
    "drag a corner; arrows move it, shift finely, Tab takes the next one",
    "Backspace makes all straight   D or Esc done",
};

/* Where nobody has thrown anything yet. */
static const char *const hint_lines[] = {
    "click the picture: throw a body; drag for speed",
    "drag a body: carry it, let go to throw it",
    "drop a recording, a scene or a model on the window",
};

static const char *state_text(const viewer *v)
{
    return v->is_at_end ? "  end: R restarts" : (v->is_paused ? "  paused" : "");
}

static char *new_line(viewer *v)
{
    v->line_marks[v->line_count] = VIEWER_MARK_NONE;
    return v->lines[v->line_count++];
}

static void add_state(viewer *v)
{
    const int32_t bodies = v->has_frame ? v->frame.snapshot->body_count : 0;
    const rlf_stage_times *t = &v->times;
    (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%.60s  %s  %s%s", v->stage.source_name,
                   rlf_view_name(v->view), v->renderer, state_text(v));
    (void)snprintf(
        new_line(v), VIEWER_LINE_SIZE, "%.1f fps  %.2f s  %d %s  throws a %s  latency %.1f ms",
        v->fps, v->has_frame ? v->frame.time_s : 0.0, (int)bodies, bodies == 1 ? "body" : "bodies",
        viewer_throw_name(v->thrown.kind), v->latency_ms);
    (void)snprintf(new_line(v), VIEWER_LINE_SIZE,
                   "ms: capture %.1f surface %.1f physics %.1f render %.1f", t->capture_ms,
                   t->surface_ms, t->physics_ms, t->render_ms);
}

/* That something is recorded is told whatever else is hidden. */
static void add_recording(viewer *v)
{
    char text[VIEWER_LINE_SIZE - 2];
    if (viewer_describe_recording(v, text, sizeof text)) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "  %s", text);
        v->line_marks[v->line_count - 1] = VIEWER_MARK_RECORDING;
    }
}

/* What is true for a moment only. */
static void add_news(viewer *v)
{
    const double drag = viewer_window_get_drag(&v->window);
    if (v->silent_s > 0) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "no frames from %.60s for %d s",
                       v->stage.source_name, (int)v->silent_s);
    }
    if (drag >= 0.0) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "throw %.1f m/s", viewer_throw_speed(drag));
    }
}

static void add_texts(viewer *v, const char *const *texts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%s", texts[i]);
    }
}

/* One quiet line, or the keys. */
static void add_help(viewer *v)
{
    if (v->place.is_on) {
        viewer_place_hint(&v->place, new_line(v));
        add_texts(v, place_lines, sizeof place_lines / sizeof place_lines[0]);
        return;
    }
    if (v->corners.is_on) {
        add_texts(v, corner_lines, sizeof corner_lines / sizeof corner_lines[0]);
        return;
    }
    const bool has_hint = v->thrown_count == 0 && rlf_clock_ns() < v->hint_end_ns;
    if (v->shows_help) {
        add_texts(v, help_lines, sizeof help_lines / sizeof help_lines[0]);
        return;
    }
    if (has_hint) {
        add_texts(v, hint_lines, sizeof hint_lines / sizeof hint_lines[0]);
    }
    (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "H keys%s", state_text(v));
}

void viewer_make_lines(viewer *v)
{
    const bool is_shown = viewer_is_overlay_shown(v);
    v->line_count = 0;
    if (is_shown && v->shows_help) {
        add_state(v);
    }
    if (is_shown || v->place.is_on || v->corners.is_on) {
        add_help(v);
    }
    add_recording(v);
    if (is_shown) {
        add_news(v);
    }
}

/* On as many lines as it needs, broken at blanks. False when it has no room. */
static bool add_message(viewer *v, const viewer_message *message, int32_t columns, int32_t most)
{
    const char *text = message->text;
    while (*text != '\0') {
        size_t length = strlen(text);
        if (length > (size_t)columns) {
            length = (size_t)columns;
            while (length > (size_t)columns / 2 && text[length] != ' ') {
                length--;
            }
        }
        if (v->line_count == most) {
            return false;
        }
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%s%.*s", message->is_error ? "  " : "",
                       (int)length, text);
        v->line_marks[v->line_count - 1] = message->is_error ? VIEWER_MARK_ERROR : VIEWER_MARK_NONE;
        text += length + strspn(text + length, " ");
    }
    return true;
}

void viewer_add_messages(viewer *v, int32_t columns)
{
    const bool is_shown = viewer_is_overlay_shown(v) || !viewer_screen_is_full(&v->window);
    const int32_t most = v->line_count + VIEWER_MESSAGE_LINES;
    for (int32_t i = 0; i < v->message_count; i++) {
        const viewer_message *m = &v->messages[i];
        if (m->end_ns != 0 && (is_shown || m->is_error) && !add_message(v, m, columns, most)) {
            return;
        }
    }
}
