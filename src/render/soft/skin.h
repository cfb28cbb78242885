/* The colours of a model's texture. */
#ifndef RLF_RENDER_SOFT_SKIN_H
#define RLF_RENDER_SOFT_SKIN_H

#include "render/soft/soft.h"

typedef struct soft_lanes_at {
    int32_t x, y, count;
} soft_lanes_at;
/* Shares of red, green and blue that the skin's texture shows in SOFT_LANES pixels of row y from x
 * on, of which `count` count; z are their depths. */
void soft_skin_colors(const soft_skin *skin, const soft_face *face, soft_lanes_at at,
                      const float *z, float rgb[3][SOFT_LANES]);

#endif
