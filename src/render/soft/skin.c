/* Colours of a model's texture along a row: trilinear (Williams 1983), SOFT_LANES pixels at a time.
 *
 * The level is chosen once for the pixels of a call, where a step of a pixel across or down the
 * picture, whichever is longer, is one texel: nothing shimmers. Two levels are mixed. */
#include "render/soft/passes.h"

#include "kernel/kernel.h"
#include "render/soft/soft.h"
#include "render/soft/stream.h"

#include <string.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define SHIFT(channel) (24 - 8 * (channel))
#else
#define SHIFT(channel) (8 * (channel))
#endif

/* One level as 32-bit texels, and pixels' places in it. */
typedef struct level {
    const uint32_t *texels;
    float width, height;
    int32_t mask_x, mask_y;
} level;

typedef struct lookup {
    float s[SOFT_LANES], t[SOFT_LANES]; /* texture coordinates */
    float weight_x[SOFT_LANES], weight_y[SOFT_LANES];
    int32_t index[4][SOFT_LANES]; /* upper left, upper right, lower left, lower right */
    uint32_t texels[4][SOFT_LANES];
} lookup;

static level level_of(const rlf_model_texture *texture, int32_t i)
{
    int32_t width, height;
    size_t offset = rlf_model_texture_level(texture, i, &width, &height);
    level l = {(const uint32_t *)(const void *)(texture->texels + offset), (float)width,
               (float)height, width - 1, height - 1};
    return l;
}

/* log2 of a positive number, to 0.01: the exponent, and a parabola through the mantissa. */
RLF_KERNEL_PART float log2_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof(bits));
    float m = (float)(bits & 0x7fffffu) * (1.0f / 8388608.0f);
    return (float)((int32_t)(bits >> 23) - 127) + m + 0.3465f * m * (1.0f - m);
}

/* Texels per pixel, squared, at a place in the picture. */
static float density2(const soft_face *f, const rlf_model_texture *texture, float dx, float dy)
{
    const soft_plane *q = &f->inverse_z;
    const soft_plane *s = &f->attribute[SOFT_S];
    const soft_plane *t = &f->attribute[SOFT_T];
    float inverse_z = q->at0 + q->dx * dx + q->dy * dy;
    inverse_z = inverse_z > f->inverse_z_min ? inverse_z : f->inverse_z_min;
    inverse_z = inverse_z < f->inverse_z_max ? inverse_z : f->inverse_z_max;
    const float z = 1.0f / inverse_z;
    const float u = (s->at0 + s->dx * dx + s->dy * dy) * z;
    const float v = (t->at0 + t->dx * dx + t->dy * dy) * z;
    const float width = (float)texture->width * z;
    const float height = (float)texture->height * z;
    const float ux = (s->dx - u * q->dx) * width;
    const float uy = (s->dy - u * q->dy) * width;
    const float vx = (t->dx - v * q->dx) * height;
    const float vy = (t->dy - v * q->dy) * height;
    const float across = ux * ux + vx * vx;
    const float down = uy * uy + vy * vy;
    return across > down ? across : down;
}

RLF_KERNEL_PART float within(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

RLF_KERNEL_PART void place(const soft_plane plane, float dx, float dy, float low, float high,
                           const float *restrict z, float *restrict out)
{
    const float at0 = plane.at0 + plane.dx * dx + plane.dy * dy;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out[i] = within((at0 + plane.dx * (float)i) * z[i], low, high);
    }
}

/* Column or row of the texel before a place, and how far the place is on the way to the next. */
RLF_KERNEL_PART void split(const float *restrict at, float size, int32_t mask,
                           float *restrict weight, int32_t *restrict before,
                           int32_t *restrict after)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float x = at[i] * size - 0.5f;
        int32_t cell = (int32_t)x;
        cell -= x < (float)cell ? 1 : 0;
        weight[i] = x - (float)cell;
        before[i] = cell & mask;
        after[i] = (cell + 1) & mask;
    }
}

RLF_KERNEL_PART void look_up(const level *l, lookup *v)
{
    int32_t left[SOFT_LANES];
    int32_t right[SOFT_LANES];
    int32_t above[SOFT_LANES];
    int32_t below[SOFT_LANES];
    const int32_t width = l->mask_x + 1;
    split(v->s, l->width, l->mask_x, v->weight_x, left, right);
    split(v->t, l->height, l->mask_y, v->weight_y, above, below);
    const uint32_t *restrict texels = l->texels;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        v->texels[0][i] = texels[above[i] * width + left[i]];
        v->texels[1][i] = texels[above[i] * width + right[i]];
        v->texels[2][i] = texels[below[i] * width + left[i]];
        v->texels[3][i] = texels[below[i] * width + right[i]];
    }
}

RLF_KERNEL_PART float channel(uint32_t texel, int32_t shift)
{
    return (float)(int32_t)(texel >> shift & 255u);
}

/* Adds `share` of the bilinear value of a channel. */
RLF_KERNEL_PART void add_channel(const lookup *v, int32_t shift, float share, float *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float a = channel(v->texels[0][i], shift);
        float c = channel(v->texels[2][i], shift);
        float top = a + (channel(v->texels[1][i], shift) - a) * v->weight_x[i];
        float bottom = c + (channel(v->texels[3][i], shift) - c) * v->weight_x[i];
        out[i] += share * (top + (bottom - top) * v->weight_y[i]);
    }
}

RLF_KERNEL_PART void add_level(const level *l, float share, lookup *v, float rgb[3][SOFT_LANES])
{
    look_up(l, v);
    for (int c = 0; c < 3; c++) {
        add_channel(v, SHIFT(c), share * (1.0f / 255.0f), rgb[c]);
    }
}

RLF_KERNEL void soft_skin_colors(const soft_skin *skin, const rlf_model_texture *texture,
                                 const soft_face *f, soft_lanes_at at, const float *z,
                                 float rgb[3][SOFT_LANES])
{
    const float dx = (float)at.x - f->origin_x;
    const float dy = (float)at.y - f->origin_y;
    const float last = (float)(texture->level_count - 1);
    lookup v;
    float middle = dx + 0.5f * (float)(at.count - 1);
    float density = within(density2(f, texture, middle, dy), 1e-6f, 1e12f);
    float detail = within(0.5f * log2_of(density), 0.0f, last);
    int32_t lower = (int32_t)detail;
    float share = detail - (float)lower;
    place(f->attribute[SOFT_S], dx, dy, skin->low[0], skin->high[0], z, v.s);
    place(f->attribute[SOFT_T], dx, dy, skin->low[1], skin->high[1], z, v.t);
    memset(rgb, 0, 3 * sizeof(rgb[0]));
    const level sharp = level_of(texture, lower);
    add_level(&sharp, 1.0f - share, &v, rgb);
    if (share > 0.0f) {
        const level coarse = level_of(texture, lower + 1);
        add_level(&coarse, share, &v, rgb);
    }
}

/* ---- metal, roughness, normals -------------------------------------------------------------- */

/* Bends unnormalised normals by what a texture says across, up and outwards. */
RLF_KERNEL_PART void bend(const soft_skin *skin, const float rgb[3][SOFT_LANES], int32_t count,
                          float *restrict nx, float *restrict ny, float *restrict nz)
{
    const float *a = skin->across;
    const float *u = skin->up;
    for (int32_t i = 0; i < count; i++) {
        const float length = sqrtf(nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i]);
        const float across = (2.0f * rgb[0][i] - 1.0f) * length;
        const float up = (2.0f * rgb[1][i] - 1.0f) * length;
        const float out = 2.0f * rgb[2][i] - 1.0f;
        nx[i] = nx[i] * out + a[0] * across + u[0] * up;
        ny[i] = ny[i] * out + a[1] * across + u[1] * up;
        nz[i] = nz[i] * out + a[2] * across + u[2] * up;
    }
}

RLF_KERNEL void soft_skin_surface(const soft_skin *skin, const soft_face *face,
                                  const stream_segment *part, int32_t y, soft_stream *v)
{
    const soft_lanes_at at = {part->x, y, part->count};
    float rgb[3][SOFT_LANES];
    if (skin->surface != NULL) {
        soft_skin_colors(skin, skin->surface, face, at, v->z + part->at, rgb);
        for (int32_t i = 0; i < part->count; i++) {
            v->roughness[part->at + i] *= rgb[1][i];
            v->metallic[part->at + i] *= rgb[2][i];
        }
    }
    if (skin->normals != NULL) {
        soft_skin_colors(skin, skin->normals, face, at, v->z + part->at, rgb);
        bend(skin, (const float(*)[SOFT_LANES])rgb, part->count, v->n[0] + part->at,
             v->n[1] + part->at, v->n[2] + part->at);
    }
}
