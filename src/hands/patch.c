/* Pixels and discs of a limb's end. */
#include "hands/patch.h"

#define PIXEL_M 0.0015   /* finer pixels tell nothing more of a hand */
#define PIXELS_LEAST 24  /* of a hand */
#define SAME_SIGMAS 6.0f /* of noise; beyond it and SAME_M a pixel is not what its cell is */
#define SAME_M 0.03f     /* two cells' slant */

#define INSIDE (INT32_MAX / 2)
#define OUTSIDE (-1)

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
    p->disc[i] = 0;
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
    p->disc[i] = INSIDE;
    p->along[i] = l->along[cell];
    return 1;
}

/* Marks what surrounds the limb. */
static void flood_outside(hand_patch *p)
{
    const int32_t w = p->width;
    int32_t count = 1;
    p->stack[0] = 0;
    p->disc[0] = OUTSIDE;
    while (count > 0) {
        const int32_t i = p->stack[--count], x = i % w, y = i / w;
        const int32_t at[4] = {x > 0 ? i - 1 : i, x < w - 1 ? i + 1 : i, y > 0 ? i - w : i,
                               y < p->height - 1 ? i + w : i};
        for (int32_t k = 0; k < 4; k++) {
            if (p->disc[at[k]] == 0) {
                p->disc[at[k]] = OUTSIDE;
                p->stack[count++] = at[k];
            }
        }
    }
}

/* What the limb surrounds is its own: the sensor lost it, or fingers do not quite touch. */
static void fill_holes(hand_patch *p)
{
    flood_outside(p);
    for (int32_t i = 0; i < p->width * p->height; i++) {
        if (p->disc[i] == 0) {
            p->disc[i] = INSIDE;
            p->z[i] = p->z[i - 1];
            p->along[i] = p->along[i - 1];
        }
    }
    for (int32_t i = 0; i < p->width * p->height; i++) {
        p->disc[i] = p->disc[i] == OUTSIDE ? 0 : INSIDE;
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
    fill_holes(p);
    hand_chamfer(p->disc, p->width, p->height);
    return true;
}
