/* Each depth pixel looks up its colour. */
#include "pipeline/moving/color_view.h"

#include <string.h>

rlf_result color_view_open(color_view *c, const rlf_rig *rig)
{
    const size_t pixels = (size_t)rig->depth.width * (size_t)rig->depth.height;
    *c = (color_view){.rgba = NULL};
    if (!rig->has_color) {
        return RLF_OK;
    }
    c->rgba = rlf_alloc_array(pixels, 4);
    c->grey = rlf_alloc(pixels);
    return c->rgba != NULL && c->grey != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

/* Where a colour camera sees a point; -1 when it does not. */
static ptrdiff_t color_pixel(const rlf_rig *rig, rlf_vec3 p_depth)
{
    double u, v;
    const rlf_vec3 p = rlf_transform(&rig->T_color_depth, p_depth);
    if (!rlf_camera_project(&rig->color, p, &u, &v) || !(u > -0.5 && v > -0.5) ||
        !(u < rig->color.width - 0.5 && v < rig->color.height - 0.5)) {
        return -1;
    }
    return (ptrdiff_t)(int32_t)(v + 0.5) * rig->color.width + (int32_t)(u + 0.5);
}

/* What is behind a nearer surface gets that one's colour: the parallax of a rig is small, and other
 * views tell. */
bool color_view_take(const color_view *c, const rlf_rig *rig, const rlf_frame *frame,
                     const rlf_surface *s)
{
    const rlf_image_rgba8 *color = &frame->color;
    if (c->rgba == NULL || color->data == NULL) {
        return false;
    }
    for (int32_t i = 0; i < s->width * s->height; i++) {
        const ptrdiff_t pixel = s->depth[i] > 0.0f ? color_pixel(rig, rlf_surface_point(s, i)) : -1;
        uint8_t *out = &c->rgba[4 * (ptrdiff_t)i];
        memset(out, 0, 4);
        c->grey[i] = 0;
        if (pixel >= 0) {
            const ptrdiff_t y = pixel / color->width, x = pixel % color->width;
            memcpy(out, (const uint8_t *)color->data + y * color->stride + 4 * x, 3);
            out[3] = 255;
            c->grey[i] = (uint8_t)(1 + (77 * out[0] + 150 * out[1] + 29 * out[2]) / 257);
        }
    }
    return true;
}

void color_view_close(color_view *c)
{
    rlf_free(c->rgba);
    rlf_free(c->grey);
    c->rgba = c->grey = NULL;
}
