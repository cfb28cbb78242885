/* What the bodies are put into: the colour picture, resized when it has to be, grey depth, or
 * nothing. */
#include "render/soft/passes.h"

#include "render/soft/draw.h"
#include "render/soft/soft.h"

#include <string.h>

static void copy_rows(const soft *s, int32_t begin, int32_t end)
{
    const rlf_image_rgba8 *image = &s->image;
    const rlf_image_rgba8 *color = &s->background;
    if (color->stride == image->stride) { /* many rows at once are sooner copied */
        memcpy(rlf_rgba8_row(image, begin), rlf_rgba8_row(color, begin),
               (size_t)(end - begin) * (size_t)image->stride);
        return;
    }
    for (int32_t y = begin; y < end; y++) {
        memcpy(rlf_rgba8_row(image, y), rlf_rgba8_row(color, y), 4 * (size_t)image->width);
    }
}

/* Position of pixel i of `to` in a line of `from` pixels: areas scale, edges repeat. */
static int32_t source_of(int32_t i, int32_t from, int32_t to, int32_t *out_weight)
{
    double at = rlf_clamp((i + 0.5) * from / to - 0.5, 0.0, from - 1.0);
    int32_t first = (int32_t)at;
    if (first > from - 2) {
        first = from > 1 ? from - 2 : 0;
    }
    *out_weight = from > 1 ? (int32_t)((at - first) * 256.0 + 0.5) : 0;
    return first;
}

static void resize_rows(const soft *s, int32_t begin, int32_t end)
{
    const rlf_image_rgba8 *color = &s->background;
    ptrdiff_t next = color->width > 1 ? 4 : 0;
    for (int32_t y = begin; y < end; y++) {
        int32_t wy;
        int32_t top = source_of(y, color->height, s->image.height, &wy);
        const uint8_t *row0 = rlf_rgba8_row(color, top);
        const uint8_t *row1 = color->height > 1 ? row0 + color->stride : row0;
        uint8_t *out = rlf_rgba8_row(&s->image, y);
        for (int32_t x = 0; x < s->image.width; x++) {
            ptrdiff_t left = 4 * (ptrdiff_t)s->column_left[x];
            int32_t wx = s->column_weight[x];
            for (int c = 0; c < 4; c++) {
                int32_t a = row0[left + c] * (256 - wx) + row0[left + next + c] * wx;
                int32_t b = row1[left + c] * (256 - wx) + row1[left + next + c] * wx;
                *out++ = (uint8_t)((a * (256 - wy) + b * wy + 32768) >> 16);
            }
        }
    }
}

/* Near is light, far is dark, unknown is black. */
static void grey_rows(const soft *s, int32_t begin, int32_t end)
{
    const rlf_rig *rig = &s->def.rig;
    const bool has_range = rig->depth_max_m > rig->depth_min_m;
    const double near = has_range ? rig->depth_min_m : 0.5;
    const double far = has_range ? rig->depth_max_m : 4.5;
    float near_z = (float)near;
    float scale = (float)(200.0 / (far - near));
    for (int32_t y = begin; y < end; y++) {
        const float *z = rlf_f32_row(&s->real.z, y);
        uint8_t *out = rlf_rgba8_row(&s->image, y);
        for (int32_t x = 0; x < s->image.width; x++) {
            float shade = 240.0f - (z[x] - near_z) * scale;
            shade = shade > 240.0f ? 240.0f : (shade < 40.0f ? 40.0f : shade);
            int32_t grey = z[x] > 0.0f ? (int32_t)shade : 0;
            soft_put(out + 4 * (ptrdiff_t)x, soft_rgb(grey, grey, grey));
        }
    }
}

void soft_set_background(soft *s, const rlf_image_rgba8 *color)
{
    s->background = *color;
    bool is_resized = color->width != s->image.width || color->height != s->image.height;
    for (int32_t x = 0; color->data != NULL && is_resized && x < s->image.width; x++) {
        s->column_left[x] = source_of(x, color->width, s->image.width, &s->column_weight[x]);
    }
}

void soft_draw_background(const soft *s, int32_t begin, int32_t end)
{
    const rlf_image_rgba8 *color = &s->background;
    if (s->is_bare) {
        memset(rlf_rgba8_row(&s->image, begin), 0, (size_t)(end - begin) * (size_t)s->image.stride);
    } else if (color->data == NULL) {
        grey_rows(s, begin, end);
    } else if (color->width == s->image.width && color->height == s->image.height) {
        copy_rows(s, begin, end);
    } else {
        resize_rows(s, begin, end);
    }
    memset(rlf_u8_row(&s->matte, begin), 0, (size_t)(end - begin) * (size_t)s->matte.width);
}
