/* The colours of views. */
#ifndef RLF_RENDER_SOFT_PALETTE_H
#define RLF_RENDER_SOFT_PALETTE_H

#include "base/inside.h"
#include "relief/surface.h"
#include "render/soft/draw.h"

soft_color soft_color_near_far(double t)
    RLF_INSIDE(soft_color_near_far); /* 0 near, bright and warm .. 1 far, dark and cold */
soft_color soft_color_hue(double turn, double value); /* turn 0..1 round the wheel, value 0..1 */
soft_color soft_color_label(int32_t label);           /* neighbours differ; 0 is black */
soft_color soft_color_reason(rlf_reason reason);

#endif
