/* Mask, holes and discs of a limb's end. */
#include "hands/limbs.h"

#define PIXEL_M 0.0015   /* finer pixels tell nothing more of a hand */
#define PIXELS_LEAST 24  /* of a hand */
#define SAME_SIGMAS 6.0f /* of noise; beyond it and SAME_M a pixel is not what its cell is */
#define SAME_M 0.03f     /* two cells' slant */
#define BEHIND_M 0.10f   /* behind the fingers; nearer than that is the own palm */
/* A finger's cross section: what is smaller is a gap in the depth. */
#define HOLE_LEAST_M2 0.0001
#define MASK_OUTSIDE 0
#define MASK_LIMB 1
#define MASK_FILLED 2
#define MASK_THROUGH 3
#define MASK_UNKNOWN 4

rlf_vec3 hand_patch_point(const hand_patch *p, int32_t i)
{
    const int32_t pixel = hand_patch_pixel(p, i);
    const double z = (double)p->z[i];
    return rlf_vec3_make(z * (double)p->surface->ray_x[pixel], z * (double)p->surface->ray_y[pixel],
                         z);
}

/* The limb's rectangle with a frame around it, in as many pixels as there is room for. */
static void place(hand_patch *p, const rlf_surface *s, const hand_cells *c, const hand_limb *limb)
{
    const int32_t across = (limb->x1 - limb->x0) * c->step;
    const int32_t down = (limb->y1 - limb->y0) * c->step;
    const int32_t longer = across > down ? across : down;
    const double pixel = (double)c->z[limb->tip] / rlf_max(s->camera.fx, 1.0);
    const int32_t room = (longer + PATCH_SIDE - 3) / (PATCH_SIDE - 2);
    const int32_t fine = (int32_t)rlf_min(PIXEL_M / pixel, 64.0);
    p->surface = s;
    p->length = (double)limb->length;
    p->step = room > fine ? room : fine;
    p->step = p->step > 1 ? p->step : 1;
    p->x0 = limb->x0 * c->step - p->step;
    p->y0 = limb->y0 * c->step - p->step;
    p->width = (across + p->step - 1) / p->step + 2;
    p->height = (down + p->step - 1) / p->step + 2;
    p->spacing = (float)(p->step / rlf_max(s->camera.fx, 1.0));
}

/* Patch pixel i, which is (x, y) of the surface. Returns 1 when it is the limb's. */
static int32_t read_pixel(hand_patch *p, const hand_cells *c, const hand_limbs *l, int32_t owner,
                          int32_t i, int32_t x, int32_t y)
{
    p->mask[i] = MASK_UNKNOWN;
    p->z[i] = 0.0f;
    p->along[i] = CELL_FAR;
    if (x < 0 || y < 0 || x >= c->width * c->step || y >= c->height * c->step) {
        return 0;
    }
    const int32_t pixel = y * p->surface->width + x;
    const float z = p->surface->depth[pixel];
    p->z[i] = z;
    if (z <= 0.0f || p->surface->foreground[pixel] == 0) {
        return 0;
    }
    const int32_t cell = y / c->step * c->width + x / c->step;
    if (l->owner[cell] != owner) {
        return 0;
    }
    const float sigma = (float)rlf_depth_noise_sigma(&c->noise, (double)z);
    if (z - c->z[cell] > SAME_M + SAME_SIGMAS * sigma) {
        return 0;
    }
    p->mask[i] = MASK_LIMB;
    p->along[i] = l->along[cell];
    return 1;
}

/* Spreads `value` over unknown pixels from pixel `first`, by sides. Lists them in the stack and
 * returns how many there are. */
static int32_t flood(hand_patch *p, int32_t first, uint8_t value)
{
    int32_t count = 1;
    p->stack[0] = first;
    p->mask[first] = value;
    for (int32_t head = 0; head < count; head++) {
        const int32_t i = p->stack[head];
        const int32_t x = i % p->width;
        const int32_t y = i / p->width;
        const int32_t at[4] = {x > 0 ? i - 1 : i, x < p->width - 1 ? i + 1 : i,
                               y > 0 ? i - p->width : i, y < p->height - 1 ? i + p->width : i};
        for (int32_t k = 0; k < 4; k++) {
            if (p->mask[at[k]] == MASK_UNKNOWN) {
                p->mask[at[k]] = value;
                p->stack[count++] = at[k];
            }
        }
    }
    return count;
}

/* Depth of the limb left of a hole. */
static int32_t limb_before(const hand_patch *p, int32_t i)
{
    while (p->mask[i] != MASK_LIMB && i % p->width > 0) {
        i--;
    }
    return i;
}

/* Through a hole one sees something behind; else the sensor lost a few pixels, which are filled. */
static void judge_hole(hand_patch *p, int32_t count)
{
    const int32_t before = limb_before(p, p->stack[0]);
    const float z = p->z[before];
    const double pixel = (double)(p->spacing * z);
    int32_t behind = 0;
    for (int32_t k = 0; k < count; k++) {
        behind += p->z[p->stack[k]] > z + BEHIND_M;
    }
    if (behind * 3 > count && count * pixel * pixel > HOLE_LEAST_M2) {
        return;
    }
    for (int32_t k = 0; k < count; k++) {
        const int32_t i = p->stack[k];
        p->mask[i] = MASK_FILLED;
        p->z[i] = z;
        p->along[i] = p->along[before];
    }
}

static void find_holes(hand_patch *p)
{
    flood(p, 0, MASK_OUTSIDE);
    for (int32_t i = 0; i < p->width * p->height; i++) {
        if (p->mask[i] == MASK_UNKNOWN) {
            judge_hole(p, flood(p, i, MASK_THROUGH));
        }
    }
}

bool hand_patch_read(hand_patch *p, const rlf_surface *s, const hand_cells *c, const hand_limbs *l,
                     int32_t k)
{
    const int32_t owner = k + 1;
    int32_t pixels = 0;
    place(p, s, c, &l->limb[k]);
    for (int32_t row = 0; row < p->height; row++) {
        for (int32_t i = row * p->width, x = p->x0; i < (row + 1) * p->width; i++, x += p->step) {
            pixels += read_pixel(p, c, l, owner, i, x, p->y0 + row * p->step);
        }
    }
    if (pixels < PIXELS_LEAST) {
        return false;
    }
    find_holes(p);
    for (int32_t i = 0; i < p->width * p->height; i++) {
        p->disc[i] = p->mask[i] == MASK_LIMB || p->mask[i] == MASK_FILLED ? INT32_MAX / 2 : 0;
    }
    hand_chamfer(p->disc, p->width, p->height);
    return true;
}
