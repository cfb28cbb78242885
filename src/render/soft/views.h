/* Views of the surface's planes. */
#ifndef RLF_RENDER_SOFT_VIEWS_H
#define RLF_RENDER_SOFT_VIEWS_H

#include "render/soft/draw.h"
#include "render/soft/soft.h"

/* Everything but camera and mesh, in the grid's own image. */
void soft_draw_view(soft *s, const rlf_render_input *input);
/* Whether a view shows the camera's colours at the surface's pixels: s->real is read then. */
bool soft_view_has_colors(const rlf_render_input *input);
/* Colour of the camera's picture where grid point i lies at depth z; grey depth without one, and
 * where something nearer hides it from the colour camera. s->real must be read. */
soft_color soft_grid_color(const soft *s, const rlf_render_input *input, int32_t i, float z);

#endif
