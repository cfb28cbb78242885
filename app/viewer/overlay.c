/* The lines of text over the picture: state, times, keys, messages. */
#include "viewer/state.h"
#include "viewer/throw.h"

#include <stdio.h>
#include <string.h>

#define MESSAGE_S 3.0 /* how long a message stays */
#define MESSAGE_COLUMNS 72
#define MESSAGE_LINES 4
#define ROW 10      /* dots from line to line */
#define MARGIN 4    /* dots */
#define BACKING 130 /* alpha of what is behind text */

static const char *const help_lines[] = {
    "Space pause   N or . one frame   R restart   L at the end",
    "arrows or the bar below: another place in the recording",
    "1 camera 2 depth 3 normals 4 mesh 5 regions",
    "6 foreground 7 background 8 velocity",
    "9 thickness 0 reason O points C contacts",
    "V next view   B beside the camera   Y mirror",
    "right drag turns points, wheel zooms",
    "click or T: throw, drag for speed   G another shape",
    "drag a body: pick it up   Delete: the one under the mouse",
    "drop a recording, a scene or a model on the window",
    "P picture   E record   F full screen   Q quit",
    "H keys   I all text   M panel   K place models of real things",
};

static const char *const place_lines[] = {
    "X cannot see that point   Backspace begin again   Enter 3 are enough",
    "arrows Page [ ] move it, shift finely   Tab next one   S save   K done",
};

void viewer_show_message(viewer *v, const char *text)
{
    (void)snprintf(v->message, sizeof v->message, "%s", text);
    v->message_end_ns = rlf_clock_ns() + (int64_t)(MESSAGE_S * VIEWER_NS_PER_S);
    v->is_present_due = true;
}

void viewer_forget_old_message(viewer *v, int64_t now_ns)
{
    if (v->message[0] != '\0' && now_ns > v->message_end_ns) {
        v->message[0] = '\0';
        v->is_present_due = true;
    }
}

static const char *state_text(const viewer *v)
{
    return v->is_at_end ? "  end: R restarts" : (v->is_paused ? "  paused" : "");
}

static char *new_line(viewer *v)
{
    return v->lines[v->line_count++];
}

static void add_state(viewer *v)
{
    const int32_t bodies = v->has_frame ? v->frame.snapshot->body_count : 0;
    const rlf_stage_times *t = &v->times;
    (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%.60s  %s  %s%s", v->stage.source_name,
                   rlf_view_name(v->view), v->renderer, state_text(v));
    (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%.1f fps  %.2f s  %d %s  throws a %s", v->fps,
                   v->has_frame ? v->frame.time_s : 0.0, (int)bodies,
                   bodies == 1 ? "body" : "bodies", viewer_throw_name(v->thrown.kind));
    (void)snprintf(new_line(v), VIEWER_LINE_SIZE,
                   "ms: capture %.1f surface %.1f physics %.1f render %.1f  latency %.1f",
                   t->capture_ms, t->surface_ms, t->physics_ms, t->render_ms, v->latency_ms);
}

/* What is true for a moment only. */
static void add_news(viewer *v)
{
    const double drag = viewer_window_get_drag(&v->window);
    if (v->silent_s > 0) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "no frames from %.60s for %d s",
                       v->stage.source_name, (int)v->silent_s);
    }
    if (v->options->on_status != NULL &&
        v->options->on_status(v->options->context, v->lines[v->line_count], VIEWER_LINE_SIZE)) {
        v->line_count++;
    }
    if (drag >= 0.0) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "throw %.1f m/s", viewer_throw_speed(drag));
    }
}

static void add_help(viewer *v)
{
    if (v->place.is_on) {
        viewer_place_hint(&v->place, new_line(v));
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%s", place_lines[0]);
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%s", place_lines[1]);
        return;
    }
    const int32_t count = v->shows_help ? (int32_t)(sizeof help_lines / sizeof help_lines[0]) : 0;
    for (int32_t i = 0; i < count; i++) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%s", help_lines[i]);
    }
    if (!v->shows_help) {
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "H keys");
    }
}

/* A message is an error's whole line: on as many lines as it needs, broken at blanks. */
static void add_message(viewer *v)
{
    const char *text = v->message;
    for (int line = 0; line < MESSAGE_LINES && *text != '\0'; line++) {
        size_t length = strlen(text);
        if (length > MESSAGE_COLUMNS) {
            length = MESSAGE_COLUMNS;
            while (length > MESSAGE_COLUMNS / 2 && text[length] != ' ') {
                length--;
            }
        }
        (void)snprintf(new_line(v), VIEWER_LINE_SIZE, "%.*s", (int)length, text);
        text += length + strspn(text + length, " ");
    }
}

static void make_lines(viewer *v)
{
    const bool is_shown = viewer_is_overlay_shown(v);
    v->line_count = 0;
    if (is_shown) {
        add_state(v);
        add_news(v);
    }
    if (v->message[0] != '\0' && (is_shown || !viewer_screen_is_full(&v->window))) {
        add_message(v);
    }
    if (is_shown || v->place.is_on) {
        add_help(v);
    }
}

/* Pixels a dot: larger in larger windows, but no line leaves the window where that can be. */
static int32_t text_scale(const viewer *v, int32_t width, int32_t height)
{
    const rlf_image_rgba8 none = {0};
    int32_t longest = 0;
    for (int32_t i = 0; i < v->line_count; i++) {
        const int32_t line = rlf_draw_text(&none, 0, 0, 1, v->lines[i]) + 2 * MARGIN;
        longest = line > longest ? line : longest;
    }
    int32_t scale = (height + 180) / 360;
    while (scale > 1 && (longest * scale > width || v->line_count * ROW * scale > height)) {
        scale--;
    }
    return scale > 1 ? scale : 1;
}

/* A dark translucent strip behind a line. */
static void back_line(const rlf_image_rgba8 *image, int32_t y, int32_t width, int32_t height)
{
    for (int32_t row = y > 0 ? y : 0; row < y + height && row < image->height; row++) {
        uint8_t *pixels = rlf_rgba8_row(image, row);
        for (int32_t x = 0; x < width && x < image->width; x++) {
            pixels[4 * (ptrdiff_t)x + 3] = BACKING;
        }
    }
}

static void draw_text(viewer *v, int32_t width, int32_t height, int32_t scale)
{
    const rlf_image_rgba8 none = {0};
    int32_t longest = 0;
    for (int32_t i = 0; i < v->line_count; i++) {
        const int32_t line = rlf_draw_text(&none, 0, 0, scale, v->lines[i]);
        longest = line > longest ? line : longest;
    }
    const int32_t box_width = longest + 2 * MARGIN * scale;
    const int32_t box_height = (v->line_count * ROW + MARGIN) * scale;
    if (!viewer_clear_image(&v->text, &v->text_size, box_width < width ? box_width : width,
                            box_height < height ? box_height : height)) {
        return;
    }
    for (int32_t i = 0; i < v->line_count; i++) {
        const int32_t y = (MARGIN + i * ROW) * scale;
        const int32_t line = rlf_draw_text(&none, 0, 0, scale, v->lines[i]);
        back_line(&v->text, y - 2 * scale, line + (MARGIN + 1) * scale, ROW * scale);
        (void)rlf_draw_text(&v->text, MARGIN * scale, y, scale, v->lines[i]);
    }
    rlf_gl_presenter_draw_over(v->presenter, &v->text, 0, 0, height);
}

void viewer_draw_overlay(viewer *v, int32_t width, int32_t height)
{
    make_lines(v);
    const int32_t scale = text_scale(v, width, height);
    if (v->line_count > 0) {
        draw_text(v, width, height, scale);
    }
    if (viewer_is_overlay_shown(v)) {
        viewer_draw_marks(v, width, height, scale);
    }
}
