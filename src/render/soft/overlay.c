/* What is written over the picture: lines of text, and a small plot of stacked bars. */
#include "render/soft/draw.h"

#define BAR 2     /* pixels of a frame, times the text's scale over two */
#define HEIGHT 40 /* of the plot, times the text's scale */
#define MARGIN 4
#define LINE 10    /* dots from line to line */
#define LINES_AT 4 /* dots from the corner */
#define LEGEND 10

static soft_color series_color(int32_t i)
{
    static const uint8_t colors[4][3] = {
        {110, 160, 255}, {250, 190, 70}, {240, 100, 90}, {120, 220, 130}};
    const uint8_t *c = colors[i % 4];
    return soft_rgb(c[0], c[1], c[2]);
}

static void draw_legend(const rlf_image_rgba8 *image, const rlf_plot *plot, int32_t scale)
{
    int32_t x = MARGIN * scale;
    for (int32_t i = 0; i < plot->series_count; i++) {
        soft_text style = {x, image->height - LEGEND * scale, scale, series_color(i), true};
        soft_draw_text(image, &style, plot->names[i]);
        x += soft_text_width(plot->names[i], scale) + 2 * MARGIN * scale;
    }
}

/* Height in pixels of a value; what is too high, or no number, ends at the top. */
static int32_t height_of(const rlf_plot *plot, float value, int32_t full)
{
    float share = value / (2.0f * plot->line);
    share = share > 0.0f ? share : 0.0f; /* also of what is no number */
    return (int32_t)((share < 1.0f ? share : 1.0f) * (float)full + 0.5f);
}

static void draw_bar(const rlf_image_rgba8 *image, const rlf_plot *plot, int32_t frame,
                     pixel_rect place)
{
    float sum = 0.0f;
    int32_t full = place.y1 - place.y0;
    for (int32_t i = 0; i < plot->series_count; i++) {
        int32_t from = height_of(plot, sum, full);
        sum += plot->values[frame * plot->series_count + i];
        pixel_rect part = {place.x0, place.y1 - height_of(plot, sum, full), place.x1,
                           place.y1 - from};
        soft_fill_rect(image, part, series_color(i), 230);
    }
}

static void draw_plot(const rlf_image_rgba8 *image, const rlf_plot *plot)
{
    int32_t scale = soft_text_scale(image->height);
    int32_t bar = (BAR * scale + 1) / 2;
    int32_t bottom = image->height - (LEGEND + MARGIN) * scale;
    pixel_rect box = {MARGIN * scale, bottom - HEIGHT * scale, MARGIN * scale + plot->count * bar,
                      bottom};
    if (!(plot->line > 0.0f) || plot->count < 1) {
        return;
    }
    soft_fill_rect(image, box, soft_rgb(0, 0, 0), 150);
    for (int32_t i = 0; i < plot->count; i++) {
        pixel_rect place = {box.x0 + i * bar, box.y0, box.x0 + (i + 1) * bar, box.y1};
        draw_bar(image, plot, i, place);
    }
    int32_t middle = box.y1 - height_of(plot, plot->line, box.y1 - box.y0);
    pixel_rect line = {box.x0, middle, box.x1, middle + (scale + 1) / 2};
    soft_fill_rect(image, line, soft_rgb(255, 255, 255), 150);
    draw_legend(image, plot, scale);
}

void soft_draw_overlay(const rlf_image_rgba8 *image, const rlf_render_input *input)
{
    int32_t scale = soft_text_scale(image->height);
    for (int32_t i = 0; i < input->overlay_count && input->overlay != NULL; i++) {
        soft_text style = {LINES_AT * scale, (LINES_AT + i * LINE) * scale, scale,
                           soft_rgb(245, 245, 235), true};
        if (input->overlay[i] != NULL && style.y < image->height) {
            soft_draw_text(image, &style, input->overlay[i]);
        }
    }
    if (input->plot != NULL) {
        draw_plot(image, input->plot);
    }
}
