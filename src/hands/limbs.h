/* Ends of limbs: the cells furthest along the foreground. */
#ifndef RLF_HANDS_LIMBS_H
#define RLF_HANDS_LIMBS_H

#include "hands/cells.h"

#define LIMBS_MAX 16      /* more than hands: feet, heads and chairs compete */
#define LIMB_PART_M 0.31f /* of its end that is looked at: a hand and a decimetre of forearm */

/* One end. */
typedef struct hand_limb {
    int32_t tip;            /* cell */
    hand_root root;         /* what it hangs on, */
    int32_t source;         /* and by which cell */
    float length;           /* from the root to the tip, metres */
    float rise;             /* how much nearer than its root the tip is, metres */
    int32_t x0, y0, x1, y1; /* cells of its end: x0 <= x < x1 */
} hand_limb;

/* Planes of one value per cell. */
typedef struct hand_limbs {
    hand_limb limb[LIMBS_MAX];
    int32_t count;
    uint8_t *owner;  /* 1 + index of the limb whose end has the cell; 0 = none */
    float *along;    /* of a cell with an owner: from that limb's tip, metres */
    float *from_tip; /* scratch, CELL_FAR between two calls */
} hand_limbs;

void hand_limbs_find(hand_limbs *l, hand_cells *c);

/* ---- side.c: left or right, by where the arm comes from */

/* > 0: a right hand, < 0: a left one; 0 = not known. */
double hand_side_of(const hand_cells *c, const hand_limb *limb, rlf_vec3 arm);

/* ---- foot.c: feet stand under a body; hands do not */

/* 0..1 that a limb that ends at `point` stands on a foot there: it is at the lower end of what is
 * seen in its place, and a body goes on high above. `down` is gravity's direction in the camera's
 * frame, unit; 0 = not known, and then nothing is a foot. */
double hand_foot_likeness(const hand_cells *c, rlf_vec3 point, rlf_vec3 down);

/* ---- patch.c: the end of one limb pixel by pixel: its mask, and how deep inside it each pixel is
 */

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
