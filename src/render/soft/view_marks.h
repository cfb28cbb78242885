/* Boxes, labels and arrows over an enlarged grid image. */
#ifndef RLF_RENDER_SOFT_VIEW_MARKS_H
#define RLF_RENDER_SOFT_VIEW_MARKS_H

#include "render/soft/soft.h"

typedef struct soft_fit {
    double scale;   /* picture pixels per grid pixel */
    int32_t x0, y0; /* of the grid image in the picture */
    int32_t width, height;
} soft_fit;

void soft_draw_region_marks(soft *s, const rlf_surface *surface, const soft_fit *fit);
void soft_draw_velocity_marks(soft *s, const rlf_surface *surface, const soft_fit *fit);

#endif
