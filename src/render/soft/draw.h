/* Colours, lines and rectangles. All is clipped to the image; points are pixels. */
#ifndef RLF_RENDER_SOFT_DRAW_H
#define RLF_RENDER_SOFT_DRAW_H

#include "camera/pixel_rect.h"
#include "relief/image.h"

typedef struct soft_color {
    uint8_t r, g, b;
} soft_color;

static inline soft_color soft_rgb(int32_t r, int32_t g, int32_t b)
{
    soft_color c = {(uint8_t)r, (uint8_t)g, (uint8_t)b};
    return c;
}
static inline void soft_put(uint8_t *pixel, soft_color c)
{
    pixel[0] = c.r;
    pixel[1] = c.g;
    pixel[2] = c.b;
    pixel[3] = 255;
}
/* Blends c over the pixel; alpha 0..256. */
static inline void soft_blend(uint8_t *pixel, soft_color c, int32_t alpha)
{
    pixel[0] = (uint8_t)(pixel[0] + (c.r - pixel[0]) * alpha / 256);
    pixel[1] = (uint8_t)(pixel[1] + (c.g - pixel[1]) * alpha / 256);
    pixel[2] = (uint8_t)(pixel[2] + (c.b - pixel[2]) * alpha / 256);
}

typedef struct soft_point {
    double x, y;
} soft_point;
void soft_draw_line(const rlf_image_rgba8 *image, soft_point from, soft_point to, soft_color color);
void soft_draw_arrow(const rlf_image_rgba8 *image, soft_point from, soft_point to,
                     soft_color color);
void soft_fill_rect(const rlf_image_rgba8 *image, pixel_rect rect, soft_color color, int32_t alpha);

#endif
