/* The view of the surface's points. */
#ifndef RLF_RENDER_SOFT_VIEW_POINTS_H
#define RLF_RENDER_SOFT_VIEW_POINTS_H

#include "render/soft/soft.h"

rlf_result soft_draw_points(soft *s, const rlf_render_input *input);

#endif
