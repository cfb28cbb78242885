/* The end of one limb pixel by pixel: its mask, and how deep inside it each pixel is. */
#ifndef RLF_HANDS_PATCH_H
#define RLF_HANDS_PATCH_H

#include "hands/limbs.h"

#define PATCH_SIDE 144 /* pixels at most, with a frame of one pixel that is outside */
#define PATCH_COUNT (PATCH_SIDE * PATCH_SIDE)

/* Pixel (x, y) of the patch is (x0 + x * step, y0 + y * step) of the surface. */
typedef struct hand_patch {
    const rlf_surface *surface;
    int32_t x0, y0, step, width, height;
    double length;             /* of the limb from its root to the tip, metres */
    float spacing;             /* metres between pixels at 1 m */
    uint8_t mask[PATCH_COUNT]; /* 1 = of the limb, 2 = filled hole; 0 = outside, 3 = seen through */
    float z[PATCH_COUNT];      /* metres; of a filled hole as of its neighbour */
    float along[PATCH_COUNT];  /* from the tip along the limb, metres */
    int32_t disc[PATCH_COUNT]; /* to the nearest edge, in pixels / CHAMFER */
    int32_t stack[PATCH_COUNT]; /* scratch */
} hand_patch;

/* Reads limb k of `l` from the surface that the cells were read from. False: too few pixels. */
bool hand_patch_read(hand_patch *p, const rlf_surface *s, const hand_cells *c, const hand_limbs *l,
                     int32_t k);

/* Index in the surface of patch pixel i. */
static inline int32_t hand_patch_pixel(const hand_patch *p, int32_t i)
{
    return (p->y0 + i / p->width * p->step) * p->surface->width + p->x0 + i % p->width * p->step;
}
/* Point of patch pixel i, metres. */
rlf_vec3 hand_patch_point(const hand_patch *p, int32_t i);
/* Radius of the disc around patch pixel i, metres. */
static inline double hand_patch_radius(const hand_patch *p, int32_t i)
{
    return (double)((float)p->disc[i] / CHAMFER * p->spacing * p->z[i]);
}

#endif
