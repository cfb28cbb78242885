/* Colour of faces, a run of pixels at a time: body colour * texture * light, as far as the samples
 * see it and the real world leaves it. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#include <string.h>

#define CHUNK 64 /* pixels between steps; a multiple of SOFT_LANES */

/* Values of some pixels in a row, between steps. */
typedef struct lanes {
    float z[CHUNK], light[CHUNK], share[CHUNK];
    float weight_x[CHUNK], weight_y[CHUNK];
    int32_t index[CHUNK];
    uint32_t texels[CHUNK];
} lanes;

RLF_KERNEL_PART float clamp(float x, float low, float high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* Linear in the picture: at0 + step i. */
typedef struct ramp {
    float at0, step;
} ramp;

RLF_KERNEL_PART ramp ramp_at(const soft_plane *plane, float dx, float dy)
{
    ramp r = {plane->at0 + plane->dx * dx + plane->dy * dy, plane->dx};
    return r;
}

typedef struct run {
    ramp inverse_z, attribute[SOFT_ATTRIBUTES];
    float inverse_z_min, inverse_z_max, texture_size;
    int32_t mask;
} run;

/* A pixel that only a corner of the face touches has its centre outside: stay within. */
RLF_KERNEL_PART void interpolate_z(const run *r, int32_t first, int32_t count,
                                   float *restrict out_z)
{
    const ramp inverse_z = r->inverse_z;
    const float low = r->inverse_z_min;
    const float high = r->inverse_z_max;
    for (int32_t i = 0; i < count; i++) {
        out_z[i] = 1.0f / clamp(inverse_z.at0 + inverse_z.step * (float)(first + i), low, high);
    }
}

RLF_KERNEL_PART void interpolate_light(const run *r, int32_t first, int32_t count,
                                       const float *restrict z, float *restrict out_light)
{
    const ramp light = r->attribute[SOFT_LIGHT];
    for (int32_t i = 0; i < count; i++) {
        out_light[i] = clamp((light.at0 + light.step * (float)(first + i)) * z[i], 0.0f, 1.0f);
    }
}

/* Texel and weights of the next one across and down. */
RLF_KERNEL_PART void interpolate_uv(const run *r, int32_t first, int32_t count,
                                    const float *restrict z, float *restrict weight_x,
                                    float *restrict weight_y, int32_t *restrict index)
{
    const ramp across = r->attribute[SOFT_S];
    const ramp down = r->attribute[SOFT_T];
    const float size = r->texture_size;
    const int32_t mask = r->mask;
    for (int32_t i = 0; i < count; i++) {
        float x = (float)(first + i);
        float s = clamp((across.at0 + across.step * x) * z[i], 0.0f, 1.0f);
        float t = clamp((down.at0 + down.step * x) * z[i], 0.0f, 1.0f);
        s = s * size + 0.5f; /* one texel more than the sample's, so that it is not negative */
        t = t * size + 0.5f;
        int32_t column = (int32_t)s;
        int32_t line = (int32_t)t;
        weight_x[i] = s - (float)column;
        weight_y[i] = t - (float)line;
        index[i] = ((line - 1) & mask) * (mask + 1) + ((column - 1) & mask);
    }
}

/* Bilinear: the four neighbours are the bytes of one texel. */
RLF_KERNEL_PART void filter(const uint32_t *restrict texels, const float *restrict weight_x,
                            const float *restrict weight_y, int32_t count, float *restrict light)
{
    for (int32_t i = 0; i < count; i++) {
        float a = (float)(int32_t)(texels[i] & 255u);
        float b = (float)(int32_t)(texels[i] >> 8 & 255u);
        float c = (float)(int32_t)(texels[i] >> 16 & 255u);
        float d = (float)(int32_t)(texels[i] >> 24);
        float top = a + (b - a) * weight_x[i];
        float bottom = c + (d - c) * weight_x[i];
        light[i] *= (top + (bottom - top) * weight_y[i]) * (1.0f / 255.0f);
    }
}

RLF_KERNEL_PART void look_up(const uint32_t *restrict texture, const int32_t *restrict index,
                             int32_t count, uint32_t *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = texture[index[i]];
    }
}

/* ---- what hides a body ---------------------------------------------------------------------- */

/* Soft: see silhouette.h; a body fades over +- 2 sigma(z) where it meets a surface. */
RLF_KERNEL_PART void share_soft(const float *restrict near_z, const float *restrict far_z,
                                const uint8_t *restrict cover, rlf_kernel_noise noise,
                                const float *restrict z, int32_t count, float *restrict share)
{
    for (int32_t i = 0; i < count; i++) {
        float fade = 0.25f / rlf_kernel_sigma(noise, z[i]);
        float near_share = clamp(0.5f + (near_z[i] - z[i]) * fade, 0.0f, 1.0f);
        float far_share = clamp(0.5f + (far_z[i] - z[i]) * fade, 0.0f, 1.0f);
        float part = (float)cover[i] * (1.0f / 255.0f);
        share[i] = far_share + (near_share - far_share) * part;
    }
}

/* Hard: the pixel's own depth counts twice, its four neighbours' once, so that edges are not
 * jagged; depth 0 is unknown and hides nothing. */
RLF_KERNEL_PART void share_hard(const soft_real_row *real, int32_t x, int32_t count, lanes *v)
{
    for (int32_t i = 0; i < count; i++) {
        int32_t at = x + i < real->width ? x + i : real->width - 1;
        int32_t left = at > 0 ? at - 1 : at;
        int32_t right = at < real->width - 1 ? at + 1 : at;
        const float taps[5] = {real->row[at], real->row[left], real->row[right], real->above[at],
                               real->below[at]};
        int32_t shown = 6;
        for (int k = 0; k < 5; k++) {
            shown -= taps[k] > 0.0f && taps[k] < v->z[i] ? (k == 0 ? 2 : 1) : 0;
        }
        v->share[i] = (float)shown * (1.0f / 6.0f);
    }
}

RLF_KERNEL_PART void share_all(int32_t count, float *restrict share)
{
    for (int32_t i = 0; i < count; i++) {
        share[i] = 1.0f;
    }
}

/* ---- runs ----------------------------------------------------------------------------------- */

/* Share of the samples that see the face, times what the real world leaves of it. */
RLF_KERNEL_PART void cover(const int32_t *restrict face, ptrdiff_t stride, int32_t id,
                           int32_t count, float *restrict share, float *restrict covered)
{
    const int32_t *restrict second = face + stride;
    const int32_t *restrict third = face + 2 * stride;
    const int32_t *restrict fourth = face + 3 * stride;
    for (int32_t i = 0; i < count; i++) {
        float a = face[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float b = second[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float c = third[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float d = fourth[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float coverage = (a + b) + (c + d);
        share[i] *= coverage;
        covered[i] += coverage;
    }
}

RLF_KERNEL_PART void add_color(const float *restrict share, const float *restrict light,
                               float color, int32_t count, float *restrict sum)
{
    for (int32_t i = 0; i < count; i++) {
        sum[i] += color * light[i] * share[i];
    }
}

RLF_KERNEL_PART void add_share(const float *restrict share, int32_t count, float *restrict sum)
{
    for (int32_t i = 0; i < count; i++) {
        sum[i] += share[i];
    }
}

static run run_of(const soft_face *f, const soft_body *body, float x, float y)
{
    float dx = x - f->origin_x;
    float dy = y - f->origin_y;
    run r = {.inverse_z = ramp_at(&f->inverse_z, dx, dy),
             .inverse_z_min = f->inverse_z_min,
             .inverse_z_max = f->inverse_z_max,
             .texture_size = (float)body->texture_size,
             .mask = body->texture_size - 1};
    for (int i = 0; i < SOFT_ATTRIBUTES; i++) {
        r.attribute[i] = ramp_at(&f->attribute[i], dx, dy);
    }
    return r;
}

/* ---- what takes light from a body ----------------------------------------------------------- */

RLF_KERNEL_PART void apply_light(const float *restrict ambient_left,
                                 const float *restrict direct_left, int32_t count,
                                 float *restrict light)
{
    const float ambient = (float)BODY_LIGHT_AMBIENT;
    for (int32_t i = 0; i < count; i++) {
        light[i] = ambient * ambient_left[i] + (light[i] - ambient) * direct_left[i];
    }
}

RLF_KERNEL_PART void fill_ones(int32_t count, float *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = 1.0f;
    }
}

/* A ball about some pixels of a row, from their first and last depth. */
RLF_KERNEL_PART float ball_of(const caster_points *points, float out[3])
{
    const int32_t last = points->count - 1;
    float z[2] = {points->z[0], points->z[last]};
    float x[2] = {points->x[0] * z[0], points->x[last] * z[1]};
    float y[2] = {points->y[0] * z[0], points->y[0] * z[1]};
    out[0] = 0.5f * (x[0] + x[1]);
    out[1] = 0.5f * (y[0] + y[1]);
    out[2] = 0.5f * (z[0] + z[1]);
    float step[3] = {x[0] - out[0], y[0] - out[1], z[0] - out[2]};
    return sqrtf(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
}

/* Other bodies' contact darkening takes the light around, their shadows the directed light. */
static void shade_by_others(const soft *s, const soft_body *body, int32_t x, int32_t y,
                            int32_t count, lanes *v)
{
    const rlf_camera *k = &s->camera;
    const float to_light[3] = {(float)s->to_light.x, (float)s->to_light.y, (float)s->to_light.z};
    float ambient_left[CHUNK];
    float direct_left[CHUNK];
    float ray_x[CHUNK];
    float ray_y[CHUNK];
    float middle[3];
    const float first = (float)((x - k->cx) / k->fx);
    const float step = (float)(1.0 / k->fx);
    const float down = (float)((y - k->cy) / k->fy);
    for (int32_t i = 0; i < count; i++) {
        ray_x[i] = first + step * (float)i;
        ray_y[i] = down;
    }
    const caster_points points = {ray_x, ray_y, v->z, count};
    float radius = ball_of(&points, middle);
    int32_t any = CASTER_TAKES_NOTHING;
    for (int32_t i = 0; i < body->shader_count; i++) {
        const caster *c = &s->scene.casters[body->shaders[i]];
        int32_t takes = caster_may_take(c, to_light, middle, radius);
        if (takes != CASTER_TAKES_NOTHING && any == CASTER_TAKES_NOTHING) {
            fill_ones(count, ambient_left);
            fill_ones(count, direct_left);
        }
        any |= takes;
        if ((takes & CASTER_TAKES_AMBIENT) != 0) {
            caster_take_ambient(c, &points, (float)BODY_AMBIENT_SHARE, ambient_left);
        }
        if ((takes & CASTER_TAKES_DIRECT) != 0) {
            caster_take_direct(c, &points, (float)BODY_DIRECT_SHARE, direct_left);
        }
    }
    if (any != CASTER_TAKES_NOTHING) {
        apply_light(ambient_left, direct_left, count, v->light);
    }
}

RLF_KERNEL void soft_shade_span(const soft *s, const soft_face *f, const soft_row *row,
                                const soft_real_row *real, const soft_span *span)
{
    const soft_body *body = &s->scene.bodies[f->body];
    run r = run_of(f, body, (float)span->x0, (float)row->y);
    lanes v;
    for (int32_t first = 0; first < span->x1 - span->x0; first += CHUNK) {
        int32_t x = span->x0 + first;
        int32_t count = span->x1 - x < CHUNK ? span->x1 - x : CHUNK;
        count = (count + SOFT_LANES - 1) / SOFT_LANES * SOFT_LANES; /* no shorter steps */
        interpolate_z(&r, first, count, v.z);
        interpolate_light(&r, first, count, v.z, v.light);
        if (body->shader_count > 0) {
            shade_by_others(s, body, x, row->y, count, &v);
        }
        interpolate_uv(&r, first, count, v.z, v.weight_x, v.weight_y, v.index);
        look_up(body->texture, v.index, count, v.texels);
        filter(v.texels, v.weight_x, v.weight_y, count, v.light);
        if (real->near_z != NULL) {
            share_soft(real->near_z + x, real->far_z + x, real->cover + x, real->noise, v.z, count,
                       v.share);
        } else if (real->row != NULL) {
            share_hard(real, x, count, &v);
        } else {
            share_all(count, v.share);
        }
        cover(row->face + x, row->stride, span->face, count, v.share, row->sum[4] + x);
        for (int k = 0; k < 3; k++) {
            add_color(v.share, v.light, body->color[k], count, row->sum[k] + x);
        }
        add_share(v.share, count, row->sum[3] + x);
    }
}

/* ---- rows ----------------------------------------------------------------------------------- */

/* The lowest byte of a pixel is red, whatever the machine's order. */
RLF_KERNEL_PART void load_pixels(const uint8_t *bytes, int32_t count, uint32_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, bytes, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < count; i++) {
        const uint8_t *p = bytes + 4 * (ptrdiff_t)i;
        out[i] = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    }
#endif
}

RLF_KERNEL_PART void store_pixels(const uint32_t *pixels, int32_t count, uint8_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, pixels, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < 4 * count; i++) {
        out[i] = (uint8_t)(pixels[i / 4] >> 8 * (i % 4));
    }
#endif
}

RLF_KERNEL_PART float over(uint32_t real, float rest, float color)
{
    float value = (float)(int32_t)(real & 255u) * rest + color + 0.5f;
    return value < 255.0f ? value : 255.0f;
}

RLF_KERNEL_PART void blend(const float *restrict red, const float *restrict green,
                           const float *restrict blue, const float *restrict shown, int32_t count,
                           uint32_t *restrict pixels)
{
    for (int32_t i = 0; i < count; i++) {
        uint32_t real = pixels[i];
        float rest = 1.0f - shown[i];
        uint32_t r = (uint32_t)(int32_t)over(real, rest, red[i]);
        uint32_t g = (uint32_t)(int32_t)over(real >> 8, rest, green[i]);
        uint32_t b = (uint32_t)(int32_t)over(real >> 16, rest, blue[i]);
        pixels[i] = r | g << 8 | b << 16 | (real & 0xff000000u);
    }
}

RLF_KERNEL_PART void to_matte(const float *restrict shown, int32_t count, uint8_t *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float alpha = 255.0f * shown[i] + 0.5f;
        out[i] = (uint8_t)(int32_t)(alpha < 255.0f ? alpha : 255.0f);
    }
}

/* Picture = real picture * (1 - alpha) + colour, colour being premultiplied. */
RLF_KERNEL void soft_compose_row(float *const sum[4], int32_t count, uint8_t *restrict pixels,
                                 uint8_t *restrict matte)
{
    uint32_t block[CHUNK];
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK;
        const float *shown = sum[3] + first;
        int32_t empty = 0;
        while (empty < size && !(shown[empty] > 0.0f)) {
            empty++;
        }
        if (empty < size) {
            load_pixels(pixels + 4 * (ptrdiff_t)first, size, block);
            blend(sum[0] + first, sum[1] + first, sum[2] + first, shown, size, block);
            store_pixels(block, size, pixels + 4 * (ptrdiff_t)first);
            to_matte(shown, size, matte + first);
        }
    }
}
