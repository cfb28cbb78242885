/* The colour of each depth pixel, for the map and the tracker. */
#ifndef RELIEF_PIPELINE_COLOR_VIEW_H
#define RELIEF_PIPELINE_COLOR_VIEW_H

#include "relief/camera.h"
#include "relief/surface.h"

typedef struct color_view {
    rlf_pool *pool;
    rlf_registration *registration;
    uint8_t *rgba, *grey; /* a depth pixel each; NULL = the rig has no colour */
} color_view;

/* Close what was opened, also after an error. */
rlf_result color_view_open(color_view *c, const rlf_rig *rig, rlf_pool *pool);
/* False when the frame has no colour. */
bool color_view_take(const color_view *c, const rlf_frame *frame, const rlf_surface *s);
void color_view_close(color_view *c);

#endif
