/* The colours of views. */
#ifndef RLF_RENDER_SOFT_PALETTE_H
#define RLF_RENDER_SOFT_PALETTE_H

#include "base/inside.h"
#include "relief/snapshot.h"
#include "relief/surface.h"
#include "render/soft/draw.h"

#define SOFT_THICKNESS_FULL_M 0.5 /* the palette's end */
#define SOFT_SPEED_FULL_M_S 1.0   /* full brightness */
#define SOFT_ARROW_S 0.25         /* an arrow of the velocity shows where a point will be */

soft_color soft_color_near_far(double t)
    RLF_INSIDE(soft_color_near_far); /* 0 near, bright and warm .. 1 far, dark and cold */
soft_color soft_color_hue(double turn, double value); /* turn 0..1 round the wheel, value 0..1 */
soft_color soft_color_label(int32_t label);           /* neighbours differ; 0 is black */
soft_color soft_color_reason(rlf_reason reason);
soft_color soft_color_normal(rlf_vec3 n); /* unit; 0 is black */
/* Direction in the picture as hue, speed in m/s as brightness up to SOFT_SPEED_FULL_M_S. */
soft_color soft_color_velocity(rlf_vec3 v);
soft_color soft_color_thickness(double metres);
soft_color soft_color_contact(rlf_contact_other other);

/* What is drawn over the picture in one colour. */
soft_color soft_color_foreground(void);
soft_color soft_color_unseen(void); /* points behind others */
soft_color soft_color_known(void);
soft_color soft_color_path(void); /* where the camera has been */
soft_color soft_color_dark(void); /* where a view from anywhere shows nothing */

#endif
