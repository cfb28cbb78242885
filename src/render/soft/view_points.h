/* The view of the surface's points, and what views from anywhere share. */
#ifndef RLF_RENDER_SOFT_VIEW_POINTS_H
#define RLF_RENDER_SOFT_VIEW_POINTS_H

#include "render/soft/soft.h"

rlf_result soft_draw_points(soft *s, const rlf_render_input *input);

/* Nothing is seen, and no depth is known. */
void soft_clear_view(soft *s);
/* Where the depth camera is: its corners, as far as they are in the picture. */
void soft_draw_frustum(const soft *s);

#endif
