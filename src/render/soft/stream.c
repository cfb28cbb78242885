/* Colour of waiting pixels: body colour * texture * light, as far as the samples see it and the
 * real world leaves it. One step for all of them after the other: none waits for the last one's
 * values to reach memory. */
#include "render/soft/stream.h"

#include "kernel/kernel.h"
#include "render/soft/passes.h"
#include "render/soft/soft.h"

#include <string.h>

RLF_KERNEL_PART void invert(int32_t count, float *restrict z)
{
    for (int32_t first = 0; first < count; first += SOFT_LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < SOFT_LANES; k++) {
            z[first + k] = 1.0f / z[first + k];
        }
    }
}

/* Texel, and in place of s and t the weights of the next one across and down. */
RLF_KERNEL_PART void place_texels(int32_t count, int32_t texture_size, const float *restrict z,
                                  float *restrict s, float *restrict t, int32_t *restrict texel)
{
    const int32_t mask = texture_size - 1;
    const float size = (float)texture_size;
    for (int32_t first = 0; first < count; first += SOFT_LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < SOFT_LANES; k++) {
            const int32_t i = first + k;
            /* one texel more than the sample's, so that it is not negative */
            float across = stream_clamp(s[i] * z[i], 0.0f, 1.0f) * size + 0.5f;
            float down = stream_clamp(t[i] * z[i], 0.0f, 1.0f) * size + 0.5f;
            int32_t column = (int32_t)across;
            int32_t line = (int32_t)down;
            s[i] = across - (float)column;
            t[i] = down - (float)line;
            texel[i] = ((line - 1) & mask) * texture_size + ((column - 1) & mask);
        }
    }
}

RLF_KERNEL_PART void look_up(int32_t count, const uint32_t *restrict texture,
                             const int32_t *restrict texel, uint32_t *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = texture[texel[i]];
    }
}

/* Bilinear: the four neighbours are the bytes of one texel. */
RLF_KERNEL_PART void filter(int32_t count, const uint32_t *restrict texels,
                            const float *restrict weight_x, const float *restrict weight_y,
                            float *restrict out)
{
    for (int32_t first = 0; first < count; first += SOFT_LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t k = 0; k < SOFT_LANES; k++) {
            const int32_t i = first + k;
            float a = (float)(int32_t)(texels[i] & 255u);
            float b = (float)(int32_t)(texels[i] >> 8 & 255u);
            float c = (float)(int32_t)(texels[i] >> 16 & 255u);
            float d = (float)(int32_t)(texels[i] >> 24);
            float top = a + (b - a) * weight_x[i];
            float bottom = c + (d - c) * weight_x[i];
            const float code = (top + (bottom - top) * weight_y[i]) * (1.0f / 255.0f);
            out[i] = code * code;
        }
    }
}

/* ---- what hides a body ---------------------------------------------------------------------- */

/* Soft: see edge_matte.h; a body fades over +- 2 sigma(z) where it meets a surface. */
RLF_KERNEL_PART void share_soft(const float *restrict near_z, const float *restrict far_z,
                                const uint8_t *restrict cover, rlf_kernel_noise noise,
                                const float *restrict z, float *restrict share)
{
    int32_t parts[SOFT_LANES]; /* by themselves: bytes among floats are not vectorised */
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        parts[i] = cover[i];
    }
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float fade = 0.25f / rlf_kernel_sigma(noise, z[i]);
        float near_share = stream_clamp(0.5f + (near_z[i] - z[i]) * fade, 0.0f, 1.0f);
        float far_share = stream_clamp(0.5f + (far_z[i] - z[i]) * fade, 0.0f, 1.0f);
        float part = (float)parts[i] * (1.0f / 255.0f);
        share[i] = far_share + (near_share - far_share) * part;
    }
}

/* The same without an edge near. */
RLF_KERNEL_PART void share_plain(const float *restrict real_z, rlf_kernel_noise noise,
                                 const float *restrict z, float *restrict share)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float here = real_z[i] > 0.0f ? real_z[i] : EDGE_MATTE_FAR;
        float fade = 0.25f / rlf_kernel_sigma(noise, z[i]);
        share[i] = stream_clamp(0.5f + (here - z[i]) * fade, 0.0f, 1.0f);
    }
}

/* Hard: the pixel's own depth counts twice, its four neighbours' once, so that edges are not
 * jagged; depth 0 is unknown and hides nothing. */
RLF_KERNEL_PART void share_hard(const soft_real_row *real, int32_t x, const float *restrict z,
                                float *restrict share)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        int32_t at = x + i < real->width ? x + i : real->width - 1;
        int32_t left = at > 0 ? at - 1 : at;
        int32_t right = at < real->width - 1 ? at + 1 : at;
        const float taps[5] = {real->row[at], real->row[left], real->row[right], real->above[at],
                               real->below[at]};
        int32_t shown = 6;
        for (int k = 0; k < 5; k++) {
            shown -= taps[k] > 0.0f && taps[k] < z[i] ? (k == 0 ? 2 : 1) : 0;
        }
        share[i] = (float)shown * (1.0f / 6.0f);
    }
}

RLF_KERNEL_PART void take_share(const float *restrict share, int32_t count,
                                float *restrict coverage)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        coverage[i] = i < count ? share[i] * coverage[i] : coverage[i];
    }
}

/* Turns the coverage of a segment into what is shown of it. */
RLF_KERNEL_PART void hide(const soft_real_row *real, const stream_segment *part,
                          const float *restrict z, float *restrict coverage)
{
    float share[SOFT_LANES];
    const int32_t x = part->x;
    if (real->marks == NULL) {
        share_hard(real, x, z, share);
    } else {
        const int32_t first = x / EDGE_MATTE_TILE;
        const int32_t last = (x + part->count - 1) / EDGE_MATTE_TILE;
        const soft_depth_range *tiles = real->tiles;
        if (tiles[first].near_z >= part->clear_z && tiles[last].near_z >= part->clear_z) {
            return;
        }
        if (((real->marks[first] | real->marks[last]) & EDGE_MATTE_EDGE) == 0) {
            share_plain(real->row + x, real->noise, z, share);
        } else {
            share_soft(real->near_z + x, real->far_z + x, real->cover + x, real->noise, z, share);
        }
    }
    take_share(share, part->count, coverage);
}

/* ---- sums ----------------------------------------------------------------------------------- */

RLF_KERNEL_PART void add(const float *restrict values, float scale, int32_t count,
                         float *restrict sum)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        sum[i] += i < count ? scale * values[i] : 0.0f;
    }
}

/* Codes of what pixels send, as far as they are shown; color linear, of one channel. */
RLF_KERNEL_PART void encode(const float *restrict color, float scale, const float *restrict times,
                            const float *restrict plus, const float *restrict shown,
                            float *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        const float sent = color[i] * scale * times[i] + plus[i];
        out[i] = shown[i] * 255.0f * sqrtf(sent < 1.0f ? sent : 1.0f);
    }
}

/* Adds what a model's face sends, as its skin colours it. */
RLF_KERNEL_PART void add_skin(const soft *s, const soft_stream *stream, const stream_segment *part,
                              const soft_row *row)
{
    const soft_face *face = &s->scene.faces[part->face];
    const soft_skin *skin = &s->scene.skins[face->skin];
    float rgb[3][SOFT_LANES];
    float codes[SOFT_LANES];
    if (skin->texture != NULL) {
        const soft_lanes_at at = {part->x, row->y, part->count};
        soft_skin_colors(skin, skin->texture, face, at, stream->z + part->at, rgb);
    }
    for (int k = 0; k < 3; k++) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < SOFT_LANES; i++) {
            rgb[k][i] = skin->texture != NULL ? rgb[k][i] * rgb[k][i] : 1.0f;
        }
        encode(rgb[k], skin->color[k], stream->times[k] + part->at, stream->plus[k] + part->at,
               stream->coverage + part->at, codes);
        add(codes, 1.0f, part->count, row->sum[k] + part->x);
    }
}

/* The first `count` values; 0 in the other lanes. */
RLF_KERNEL_PART void take_lanes(const float *restrict values, int32_t count, float *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out[i] = i < count ? values[i] : 0.0f;
    }
}

RLF_KERNEL_PART void add_lanes(const float *restrict lanes, float scale, float *restrict sum)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        sum[i] += scale * lanes[i];
    }
}

RLF_KERNEL_PART void add_segment(const soft *s, const soft_stream *stream,
                                 const stream_segment *part, const soft_row *row)
{
    float lanes[SOFT_LANES];
    if (stream->has_skin) {
        add_skin(s, stream, part, row);
    } else {
        for (int k = 0; k < 3; k++) {
            take_lanes(stream->codes[k] + part->at, part->count, lanes);
            add_lanes(lanes, 1.0f, row->sum[k] + part->x);
        }
    }
    take_lanes(stream->coverage + part->at, part->count, lanes);
    add_lanes(lanes, 1.0f, row->sum[3] + part->x);
}

/* ---- all of it ------------------------------------------------------------------------------ */

/* What is beyond the last lane is worked on too. */
static void end_lanes(soft_stream *v)
{
    float *const all[11] = {v->coverage, v->n[0],  v->n[1],    v->n[2],   v->s,       v->t,
                            v->ray_x,    v->ray_y, v->ambient, v->direct, v->metallic};
    for (int k = 0; k < 11; k++) {
        memset(all[k] + v->count, 0, SOFT_LANES * sizeof(float));
    }
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        v->z[v->count + i] = v->roughness[v->count + i] = 1.0f;
    }
}

RLF_KERNEL void soft_stream_flush(const soft *s, const soft_group *group, soft_stream *v)
{
    const int32_t count = v->count;
    const soft_body *body = v->body;
    if (count == 0) {
        return;
    }
    end_lanes(v);
    invert(count, v->z);
    float light[3];
    caster_to_floats(s->to_light, light);
    for (int32_t i = 0; v->has_skin && i < v->segment_count; i++) {
        const stream_segment *part = &v->segments[i];
        const soft_face *face = &s->scene.faces[part->face];
        soft_skin_surface(&s->scene.skins[face->skin], face, part, group->rows[part->row].y, v);
    }
    soft_light_lanes(body->probe, light, v);
    if (!v->has_skin) {
        place_texels(count, body->texture_size, v->z, v->s, v->t, v->texel);
        look_up(count, body->texture, v->texel, v->texels);
    }
    for (int32_t i = 0; i < v->segment_count; i++) {
        const stream_segment *part = &v->segments[i];
        const soft_row *row = &group->rows[part->row];
        if (s->def.occlusion == RLF_OCCLUSION_THESIS) {
            add(v->coverage + part->at, 1.0f, part->count, row->sum[SOFT_COVERED] + part->x);
        }
        if (row->real.row != NULL) {
            hide(&row->real, part, v->z + part->at, v->coverage + part->at);
        }
    }
    if (!v->has_skin) {
        filter(count, v->texels, v->s, v->t, v->pattern);
        for (int32_t first = 0; first < count; first += SOFT_LANES) {
            for (int k = 0; k < 3; k++) {
                encode(v->pattern + first, body->color[k], v->times[k] + first, v->plus[k] + first,
                       v->coverage + first, v->codes[k] + first);
            }
        }
    }
    for (int32_t i = 0; i < v->segment_count; i++) {
        const stream_segment *part = &v->segments[i];
        add_segment(s, v, part, &group->rows[part->row]);
    }
    v->count = 0;
    v->segment_count = 0;
}
