/* The view of the fused room. */
#ifndef RLF_RENDER_SOFT_VIEW_MAP_H
#define RLF_RENDER_SOFT_VIEW_MAP_H

#include "render/soft/soft.h"

rlf_result soft_draw_map(soft *s, const rlf_render_input *input);

#endif
