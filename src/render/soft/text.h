/* Lines of text, `scale` pixels a dot of a letter. */
#ifndef RLF_RENDER_SOFT_TEXT_H
#define RLF_RENDER_SOFT_TEXT_H

#include "render/soft/draw.h"

typedef struct soft_text {
    int32_t x, y; /* top left, pixels */
    int32_t scale;
    soft_color color;
    bool has_backing; /* a dark translucent strip behind it */
} soft_text;

int32_t soft_text_scale(int32_t picture_height);
int32_t soft_text_width(const char *line, int32_t scale);
void soft_draw_text(const rlf_image_rgba8 *image, const soft_text *style, const char *line);

#endif
