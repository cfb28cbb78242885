/* Bodies over the picture. */
#ifndef RLF_RENDER_SOFT_BODIES_H
#define RLF_RENDER_SOFT_BODIES_H

#include "render/soft/soft.h"

/* Draws the scene over the image and writes the matte; with_background: first the background, in
 * the same go through memory. */
void soft_draw_bodies(soft *s, bool with_background);

#endif
