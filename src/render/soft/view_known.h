/* The view of models of real things. */
#ifndef RLF_RENDER_SOFT_VIEW_KNOWN_H
#define RLF_RENDER_SOFT_VIEW_KNOWN_H

#include "render/soft/soft.h"

/* Over the camera's picture. */
void soft_draw_known(soft *s, const rlf_render_input *input);

#endif
