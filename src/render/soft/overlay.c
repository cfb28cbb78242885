/* What is written over the picture: lines of text and the plot. */
#include "render/soft/soft.h"

#define LINE 10 /* dots from line to line */
#define MARGIN 2

void soft_draw_overlay(const rlf_image_rgba8 *image, const rlf_render_input *input)
{
    int32_t scale = soft_text_scale(image->height);
    for (int32_t i = 0; i < input->overlay_count && input->overlay != NULL; i++) {
        soft_text style = {(MARGIN + 2) * scale, (MARGIN + 2 + i * LINE) * scale, scale,
                           soft_rgb(245, 245, 235), true};
        if (input->overlay[i] != NULL && style.y < image->height) {
            soft_draw_text(image, &style, input->overlay[i]);
        }
    }
    if (input->plot != NULL) {
        soft_draw_plot(image, input->plot);
    }
}
