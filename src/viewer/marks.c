/* Marks over the picture: a plot of the stages' times, and the seek bar. */
#include "viewer/state.h"

#include <stdio.h>
#include <string.h>

#define PLOT_HEIGHT 40 /* dots */
#define PLOT_WIDTH 220
#define PLOT_MS 66.7f /* that the plot's height stands for: two frames of a camera */
#define MARGIN 4
#define LEGEND 10
#define SEEK_HEIGHT 0.045 /* of the window */
#define SEEK_MARGIN 0.02

typedef struct mark_rect {
    int32_t x0, y0, x1, y1;
} mark_rect;

static void fill(const rlf_image_rgba8 *image, mark_rect r, const uint8_t color[4])
{
    for (int32_t y = r.y0 > 0 ? r.y0 : 0; y < r.y1 && y < image->height; y++) {
        uint8_t *row = rlf_rgba8_row(image, y);
        for (int32_t x = r.x0 > 0 ? r.x0 : 0; x < r.x1 && x < image->width; x++) {
            memcpy(row + 4 * (ptrdiff_t)x, color, 4);
        }
    }
}

void viewer_note_plot(viewer *v)
{
    const rlf_stage_times *t = &v->frame.times;
    const float values[VIEWER_PLOT_STAGES] = {(float)t->capture_ms, (float)t->surface_ms,
                                              (float)t->physics_ms, (float)t->render_ms};
    if (v->plot_count == VIEWER_PLOT_FRAMES) {
        v->plot_count--;
        memmove(v->plot[0], v->plot[1], sizeof v->plot - sizeof v->plot[0]);
    }
    memcpy(v->plot[v->plot_count++], values, sizeof values);
}

static const uint8_t stage_colors[VIEWER_PLOT_STAGES][4] = {
    {110, 160, 255, 230}, {250, 190, 70, 230}, {240, 100, 90, 230}, {120, 220, 130, 230}};

static void draw_legend(const rlf_image_rgba8 *image, int32_t y, int32_t scale)
{
    static const char *const names[VIEWER_PLOT_STAGES] = {"capture", "surface", "physics",
                                                          "render"};
    int32_t x = MARGIN * scale;
    for (int i = 0; i < VIEWER_PLOT_STAGES; i++) {
        const mark_rect key = {x, y, x + 6 * scale, y + 7 * scale};
        fill(image, key, stage_colors[i]);
        x += 8 * scale;
        x += rlf_draw_text(image, x, y, scale, names[i]) + MARGIN * scale;
    }
}

static void draw_plot(viewer *v, int32_t width, int32_t height, int32_t bottom, int32_t scale)
{
    const uint8_t back[4] = {0, 0, 0, 150};
    const uint8_t line[4] = {255, 255, 255, 150};
    const int32_t w = PLOT_WIDTH * scale < width ? PLOT_WIDTH * scale : width;
    const int32_t h =
        (PLOT_HEIGHT + LEGEND) * scale < bottom ? (PLOT_HEIGHT + LEGEND) * scale : bottom;
    const int32_t base = PLOT_HEIGHT * scale;
    if (v->plot_count < 1 || h < 1 || w < 1 ||
        !viewer_clear_image(&v->marks, &v->marks_size, w, h)) {
        return;
    }
    fill(&v->marks, (mark_rect){0, 0, w, h}, back);
    for (int32_t i = 0; i < v->plot_count; i++) {
        float sum = 0.0f;
        for (int k = 0; k < VIEWER_PLOT_STAGES; k++) {
            const int32_t from = base - (int32_t)((float)base * sum / PLOT_MS);
            sum += v->plot[i][k];
            const mark_rect part = {i * w / VIEWER_PLOT_FRAMES,
                                    base - (int32_t)((float)base * sum / PLOT_MS),
                                    (i + 1) * w / VIEWER_PLOT_FRAMES, from};
            fill(&v->marks, part, stage_colors[k]);
        }
    }
    fill(&v->marks, (mark_rect){0, base / 2, w, base / 2 + (scale + 1) / 2}, line);
    draw_legend(&v->marks, base + 2 * scale, scale);
    rlf_gl_presenter_draw_over(v->presenter, &v->marks, 0, bottom - h, height);
}

static bool has_seek_bar(const viewer *v)
{
    return v->stage.playback != NULL && rlf_playback_get_count(v->stage.playback) > 1;
}

/* The bar in a window, or a framebuffer, of that size. */
static mark_rect seek_rect(int32_t width, int32_t height)
{
    const int32_t h = (int32_t)(SEEK_HEIGHT * height + 0.5);
    const int32_t margin = (int32_t)(SEEK_MARGIN * height + 0.5);
    return (mark_rect){margin, height - margin - h, width - margin, height - margin};
}

bool viewer_seek_pick(const viewer *v, double x, double y, bool is_held, double *out)
{
    int32_t width, height;
    viewer_get_area(v, &width, &height);
    const mark_rect r = seek_rect(width, height);
    const bool is_shown = has_seek_bar(v) && viewer_is_overlay_shown(v) && r.x1 > r.x0;
    *out = is_shown ? rlf_clamp((x - r.x0) / (r.x1 - r.x0), 0.0, 1.0) : 0.0;
    return is_shown && (is_held || (x >= r.x0 && x < r.x1 && y >= r.y0 && y < r.y1));
}

static void draw_seek_bar(viewer *v, int32_t width, int32_t height, int32_t scale)
{
    const uint8_t back[4] = {0, 0, 0, 150};
    const uint8_t left[4] = {110, 110, 110, 230};
    const uint8_t done[4] = {250, 190, 70, 230};
    const rlf_playback *p = v->stage.playback;
    const mark_rect r = seek_rect(width, height);
    const int32_t w = r.x1 - r.x0;
    const int32_t h = r.y1 - r.y0;
    char text[48];
    if (w < 1 || h < 1 || !viewer_clear_image(&v->marks, &v->marks_size, w, h)) {
        return;
    }
    const int64_t count = rlf_playback_get_count(p);
    const int64_t index = rlf_playback_get_index(p) > 0 ? rlf_playback_get_index(p) : 0;
    if (v->shows_help) {
        fill(&v->marks, (mark_rect){0, 0, w, h}, back);
    }
    fill(&v->marks, (mark_rect){0, h - (h + 3) / 4, w, h}, left);
    fill(&v->marks, (mark_rect){0, h - (h + 3) / 4, (int32_t)(index * w / (count - 1)), h}, done);
    (void)snprintf(text, sizeof text, "%lld of %lld  %s", (long long)index, (long long)count - 1,
                   rlf_playback_name(rlf_playback_get_end(p)));
    if (v->shows_help) {
        (void)rlf_draw_text(&v->marks, MARGIN * scale, (3 * h / 4 - 7 * scale) / 2, scale, text);
    }
    rlf_gl_presenter_draw_over(v->presenter, &v->marks, r.x0, r.y0, height);
}

/* What the view's colours mean, at the lower right. */
static void draw_view_legend(viewer *v, int32_t width, int32_t height, int32_t bottom,
                             int32_t scale)
{
    const uint8_t back[4] = {0, 0, 0, 150};
    const rlf_image_rgba8 none = {0};
    rlf_compositor_def def = rlf_pipeline_get_compositor_def(v->stage.pipeline);
    const rlf_legend legend = rlf_view_legend(v->view, &def.rig);
    int32_t widest = legend.title != NULL ? rlf_draw_text(&none, 0, 0, scale, legend.title) : 0;
    for (int32_t i = 0; i < legend.row_count; i++) {
        const int32_t row = rlf_draw_text(&none, 0, 0, scale, legend.rows[i].text) + 10 * scale;
        widest = row > widest ? row : widest;
    }
    const int32_t w = widest + 2 * MARGIN * scale;
    const int32_t h = (LEGEND * (legend.row_count + 1) + MARGIN) * scale;
    if (legend.row_count < 1 || w > width || h > bottom ||
        !viewer_clear_image(&v->marks, &v->marks_size, w, h)) {
        return;
    }
    fill(&v->marks, (mark_rect){0, 0, w, h}, back);
    (void)rlf_draw_text(&v->marks, MARGIN * scale, MARGIN * scale, scale, legend.title);
    for (int32_t i = 0; i < legend.row_count; i++) {
        const rlf_legend_row *row = &legend.rows[i];
        const uint8_t color[4] = {row->r, row->g, row->b, 255};
        const int32_t x = MARGIN * scale;
        const int32_t y = (MARGIN + LEGEND * (i + 1)) * scale;
        fill(&v->marks, (mark_rect){x, y, x + 7 * scale, y + 7 * scale}, color);
        (void)rlf_draw_text(&v->marks, x + 10 * scale, y, scale, row->text);
    }
    rlf_gl_presenter_draw_over(v->presenter, &v->marks, width - w, bottom - h, height);
}

void viewer_draw_marks(viewer *v, int32_t width, int32_t height, int32_t scale)
{
    const bool has_bar = has_seek_bar(v);
    const int32_t bottom = has_bar ? seek_rect(width, height).y0 - MARGIN : height;
    if (v->shows_help && v->window.panel_width == 0) { /* the panel has a plot of its own */
        draw_plot(v, width, height, bottom, scale);
    }
    draw_view_legend(v, width, height, bottom, scale);
    if (has_bar) {
        draw_seek_bar(v, width, height, scale);
    }
}
