/* What is written over the picture; shared with the GL renderer. */
#ifndef RLF_RENDER_SOFT_OVERLAY_H
#define RLF_RENDER_SOFT_OVERLAY_H

#include "base/inside.h"
#include "relief/compositor.h"

/* Lines and plot of an input. */
void soft_draw_overlay(const rlf_image_rgba8 *image, const rlf_render_input *input)
    RLF_INSIDE(soft_draw_overlay);

#endif
