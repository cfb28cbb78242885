/* Shadows of bodies on real surfaces. */
#ifndef RLF_RENDER_SOFT_SHADOW_H
#define RLF_RENDER_SOFT_SHADOW_H

#include "render/soft/soft.h"

/* Darkens the real surfaces of rows [begin, end) that the bodies keep the light from. */
void soft_draw_shadows(const soft *s, soft_shade_tile *tiles, int32_t begin, int32_t end);

#endif
