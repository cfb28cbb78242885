/* Draws lines of text over the picture, at the window's resolution. */
#include "viewer/state.h"

#include <string.h>

#define LETTER 6         /* dots */
#define COLUMNS_USUAL 64 /* room of lines whose numbers grow and shrink */
#define COLUMNS_MIN 24
#define COLUMNS_MAX 100 /* of a message; longer lines are hard to read */
#define ROW 10          /* dots from line to line */
#define MARGIN 4        /* dots */
#define BACKING 130     /* alpha of what is behind text */

/* Pixels a dot: larger in larger windows, but no line leaves the window where that can be. Messages
 * have their room when there are none, too, so that they change nothing else. */
static int32_t text_scale(const viewer *v, int32_t width, int32_t height)
{
    const rlf_image_rgba8 none = {0};
    int32_t longest = LETTER * COLUMNS_USUAL + 2 * MARGIN;
    for (int32_t i = 0; i < v->line_count; i++) {
        const int32_t line = rlf_draw_text(&none, 0, 0, 1, v->lines[i]) + 2 * MARGIN;
        longest = line > longest ? line : longest;
    }
    int32_t scale = (height + 180) / 360;
    const int32_t rows = v->line_count + VIEWER_MESSAGE_LINES;
    while (scale > 1 && (longest * scale > width || rows * ROW * scale > height)) {
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

/* A red dot where something is recorded, a red bar at an error. */
static void draw_mark(const rlf_image_rgba8 *image, viewer_mark mark, int32_t y, int32_t scale)
{
    const uint8_t red[4] = {240, 60, 50, 255};
    const int32_t side = 7 * scale;
    for (int32_t row = 0; row < side && y + row < image->height; row++) {
        uint8_t *pixels = rlf_rgba8_row(image, y + row);
        for (int32_t x = 0; x < side && x + MARGIN * scale < image->width; x++) {
            const int32_t dx = 2 * x + 1 - side;
            const int32_t dy = 2 * row + 1 - side;
            if (mark == VIEWER_MARK_ERROR ? x < 3 * scale : dx * dx + dy * dy <= side * side) {
                memcpy(pixels + 4 * (ptrdiff_t)(x + MARGIN * scale), red, 4);
            }
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
        if (v->line_marks[i] != VIEWER_MARK_NONE) {
            draw_mark(&v->text, v->line_marks[i], y, scale);
        }
    }
    rlf_gl_presenter_draw_over(v->presenter, &v->text, 0, 0, height);
}

void viewer_draw_overlay(viewer *v, int32_t width, int32_t height)
{
    viewer_make_lines(v);
    const int32_t scale = text_scale(v, width, height);
    const int32_t columns = width / (LETTER * scale) - 4;
    viewer_add_messages(v, columns < COLUMNS_MIN   ? COLUMNS_MIN
                           : columns > COLUMNS_MAX ? COLUMNS_MAX
                                                   : columns);
    if (v->line_count > 0 && v->panel == NULL) { /* else that writes them */
        draw_text(v, width, height, scale);
    }
    if (viewer_is_overlay_shown(v)) {
        viewer_draw_marks(v, width, height, scale);
    }
}
