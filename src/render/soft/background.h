/* The picture before any body is in it. */
#ifndef RLF_RENDER_SOFT_BACKGROUND_H
#define RLF_RENDER_SOFT_BACKGROUND_H

#include "render/soft/soft.h"

/* The colour picture, or, when it has no data, registered depth in grey. */
void soft_set_background(soft *s, const rlf_image_rgba8 *color);
/* Rows [begin, end) of it; the matte there becomes 0. Real depth must be up to date if it is grey.
 */
void soft_draw_background(const soft *s, int32_t begin, int32_t end);

#endif
