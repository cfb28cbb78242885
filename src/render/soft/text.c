/* Letters of a fixed font. */
#include "render/soft/draw.h"

#include "relief/compositor.h"

#include <string.h>

#define ADVANCE 6 /* dots from letter to letter */
#define LETTER 5
#define HEIGHT 7
#define MARGIN 2
#define LINE_MAX_BYTES 512

int32_t soft_text_scale(int32_t picture_height)
{
    int32_t scale = (picture_height + 150) / 300;
    return scale < 1 ? 1 : scale;
}

int32_t soft_text_width(const char *line, int32_t scale)
{
    size_t length = strlen(line);
    return (int32_t)(length < LINE_MAX_BYTES ? length : LINE_MAX_BYTES) * ADVANCE * scale;
}

static void draw_letter(const rlf_image_rgba8 *image, const soft_text *style, int32_t x,
                        char letter)
{
    int code = (unsigned char)letter;
    const uint8_t *rows = soft_font[code >= 32 && code < 127 ? code - 32 : '?' - 32];
    int32_t scale = style->scale;
    for (int32_t row = 0; row < HEIGHT; row++) {
        for (int32_t column = 0; column < LETTER; column++) {
            if ((rows[row] >> (LETTER - 1 - column) & 1) != 0) {
                pixel_rect dot = {x + column * scale, style->y + row * scale,
                                  x + (column + 1) * scale, style->y + (row + 1) * scale};
                soft_fill_rect(image, dot, style->color, 256);
            }
        }
    }
}

void soft_draw_text(const rlf_image_rgba8 *image, const soft_text *style, const char *line)
{
    int32_t scale = style->scale;
    if (style->has_backing) {
        pixel_rect strip = {style->x - MARGIN * scale, style->y - MARGIN * scale,
                            style->x + soft_text_width(line, scale) + scale,
                            style->y + (HEIGHT + 1) * scale};
        soft_fill_rect(image, strip, soft_rgb(0, 0, 0), 150);
    }
    int32_t x = style->x;
    for (int32_t i = 0; line[i] != '\0' && i < LINE_MAX_BYTES && x < image->width; i++) {
        draw_letter(image, style, x, line[i]);
        x += ADVANCE * scale;
    }
}

int32_t rlf_draw_text(const rlf_image_rgba8 *image, int32_t x, int32_t y, int32_t scale,
                      const char *line)
{
    if (!RLF_ASSERT(image != NULL && line != NULL && scale >= 1)) {
        return 0;
    }
    const int32_t width = soft_text_width(line, scale);
    const soft_text style = {x, y, scale, soft_rgb(245, 245, 235), false};
    if (image->data == NULL) {
        return width;
    }
    soft_draw_text(image, &style, line);
    const int32_t x1 = x + width < image->width ? x + width : image->width;
    const int32_t y1 = y + HEIGHT * scale < image->height ? y + HEIGHT * scale : image->height;
    for (int32_t row = y > 0 ? y : 0; row < y1; row++) {
        uint8_t *pixels = rlf_rgba8_row(image, row);
        for (int32_t i = x > 0 ? x : 0; i < x1; i++) {
            uint8_t *p = pixels + 4 * (ptrdiff_t)i;
            p[3] = p[0] == 245 && p[1] == 245 && p[2] == 235 ? 255 : p[3];
        }
    }
    return width;
}
