/* What is left of the light on a body's faces, at nodes a few pixels apart. */
#ifndef RLF_RENDER_SOFT_BODY_LIGHT_H
#define RLF_RENDER_SOFT_BODY_LIGHT_H

#include "render/soft/soft.h"

#define CHUNK_NODES 12 /* pixels of so many nodes at a time: the last block needs more */

/* What other bodies leave of the light around and of the directed light: `per_row` nodes of one
 * row, then of another. */
typedef struct light_nodes {
    int32_t per_row;
    float ambient[2 * ROW_NODES], direct[2 * ROW_NODES];
} light_nodes;

/* Linear in the picture: at0 + step i. */
typedef struct ramp {
    float at0, step;
} ramp;

RLF_KERNEL_PART ramp ramp_at(const soft_plane *plane, float dx, float dy)
{
    ramp r = {plane->at0 + plane->dx * dx + plane->dy * dy, plane->dx};
    return r;
}

/* What is left at nodes of rows y0 and y1 from x on, of which `count` pixels will be drawn. False
 * when nothing takes any. */
bool soft_fill_nodes(const soft *s, const soft_face *f, const int32_t y[2], int32_t x,
                     int32_t count, light_nodes *out);

#endif
