/* Lines and rectangles. */
#include "render/soft/draw.h"

void soft_fill_rect(const rlf_image_rgba8 *image, pixel_rect rect, soft_color color, int32_t alpha)
{
    int32_t x0 = rect.x0 > 0 ? rect.x0 : 0;
    int32_t y0 = rect.y0 > 0 ? rect.y0 : 0;
    int32_t x1 = rect.x1 < image->width ? rect.x1 : image->width;
    int32_t y1 = rect.y1 < image->height ? rect.y1 : image->height;
    for (int32_t y = y0; y < y1; y++) {
        uint8_t *row = rlf_rgba8_row(image, y);
        for (int32_t x = x0; x < x1; x++) {
            soft_blend(row + 4 * (ptrdiff_t)x, color, alpha);
        }
    }
}

/* Shortens the line to 0..limit along one axis; false when nothing is left (Liang, Barsky 1984). */
static bool clip_axis(double from, double to, double limit, double t[2])
{
    double d = to - from;
    if (d == 0.0) {
        return from >= 0.0 && from <= limit;
    }
    double enter = ((d > 0.0 ? 0.0 : limit) - from) / d;
    double leave = ((d > 0.0 ? limit : 0.0) - from) / d;
    t[0] = rlf_max(t[0], enter);
    t[1] = rlf_min(t[1], leave);
    return t[0] <= t[1];
}

static void blend_at(const rlf_image_rgba8 *image, int32_t x, int32_t y, soft_color color,
                     double alpha)
{
    if (x >= 0 && y >= 0 && x < image->width && y < image->height) {
        soft_blend(rlf_rgba8_row(image, y) + 4 * (ptrdiff_t)x, color, (int32_t)(alpha * 256.0));
    }
}

void soft_draw_line(const rlf_image_rgba8 *image, soft_point from, soft_point to, soft_color color)
{
    double t[2] = {0.0, 1.0};
    if (!rlf_is_finite(from.x + from.y + to.x + to.y) ||
        !clip_axis(from.x, to.x, image->width - 1.0, t) ||
        !clip_axis(from.y, to.y, image->height - 1.0, t)) {
        return;
    }
    double dx = to.x - from.x;
    double dy = to.y - from.y;
    soft_point a = {from.x + dx * t[0], from.y + dy * t[0]};
    soft_point b = {from.x + dx * t[1], from.y + dy * t[1]};
    dx = b.x - a.x;
    dy = b.y - a.y;
    bool is_steep = dy * dy > dx * dx;
    double length = is_steep ? dy : dx;
    int32_t steps = (int32_t)(length < 0.0 ? -length : length) + 1;
    /* One pixel along, two pixels across share the colour by nearness (Wu 1991). */
    for (int32_t i = 0; i <= steps; i++) {
        double x = a.x + dx * i / steps;
        double y = a.y + dy * i / steps;
        int32_t along = (int32_t)((is_steep ? y : x) + 0.5);
        double across = is_steep ? x : y;
        int32_t cell = (int32_t)across;
        double w = across - cell;
        for (int side = 0; side < 2; side++) {
            double alpha = side == 0 ? 1.0 - w : w;
            if (is_steep) {
                blend_at(image, cell + side, along, color, alpha);
            } else {
                blend_at(image, along, cell + side, color, alpha);
            }
        }
    }
}

void soft_draw_arrow(const rlf_image_rgba8 *image, soft_point from, soft_point to, soft_color color)
{
    double dx = to.x - from.x;
    double dy = to.y - from.y;
    if (dx * dx + dy * dy < 4.0) {
        return;
    }
    soft_draw_line(image, from, to, color);
    for (int side = -1; side <= 1; side += 2) {
        soft_point barb = {to.x - 0.25 * (dx + 0.6 * side * dy),
                           to.y - 0.25 * (dy - 0.6 * side * dx)};
        soft_draw_line(image, to, barb, color);
    }
}
