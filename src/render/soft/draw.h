/* Colours, lines and rectangles. All is clipped to the image; points are pixels. */
#ifndef RLF_RENDER_SOFT_DRAW_H
#define RLF_RENDER_SOFT_DRAW_H

#include "base/inside.h"
#include "camera/pixel_rect.h"
#include "relief/compositor.h"
#include "relief/image.h"
#include "relief/snapshot.h"
#include "relief/surface.h"

#include <stdint.h>

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

/* ---- palette.c: the colours of views. */

#define SOFT_THICKNESS_FULL_M 0.5 /* the palette's end */
#define SOFT_SPEED_FULL_M_S 1.0   /* full brightness */
#define SOFT_ARROW_S 0.25         /* an arrow of the velocity shows where a point will be */

soft_color soft_color_near_far(double t)
    RLF_INSIDE(soft_color_near_far); /* 0 near, bright and warm .. 1 far, dark and cold */
soft_color soft_color_hue(double turn, double value); /* turn 0..1 round the wheel, value 0..1 */
soft_color soft_color_label(int32_t label);           /* neighbours differ; 0 is black */
soft_color soft_color_reason(rlf_reason reason);
soft_color soft_color_normal(rlf_vec3 n); /* unit; 0 is black */
/* Direction in the picture as hue, speed in m/s as brightness up to SOFT_SPEED_FULL_M_S. */
soft_color soft_color_velocity(rlf_vec3 v);
soft_color soft_color_thickness(double metres);
soft_color soft_color_contact(rlf_contact_other other);

/* What is drawn over the picture in one colour. */
soft_color soft_color_foreground(void);
soft_color soft_color_unseen(void); /* points behind others */
soft_color soft_color_known(void);
soft_color soft_color_path(void); /* where the camera has been */
soft_color soft_color_dark(void); /* where a view from anywhere shows nothing */

/* ---- font.c: letters of 5 x 7 dots. */

extern const uint8_t soft_font[95][7]; /* ' ' to '~', rows from the top, bit 4 is left */

/* ---- text.c: lines of text, `scale` pixels a dot of a letter. */

typedef struct soft_text {
    int32_t x, y; /* top left, pixels */
    int32_t scale;
    soft_color color;
    bool has_backing; /* a dark translucent strip behind it */
} soft_text;

int32_t soft_text_scale(int32_t picture_height);
int32_t soft_text_width(const char *line, int32_t scale);
void soft_draw_text(const rlf_image_rgba8 *image, const soft_text *style, const char *line);

/* ---- overlay.c: what is written over the picture; shared with the GL renderer. */

/* Lines and plot of an input. */
void soft_draw_overlay(const rlf_image_rgba8 *image, const rlf_render_input *input)
    RLF_INSIDE(soft_draw_overlay);

#endif
