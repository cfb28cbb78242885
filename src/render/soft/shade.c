/* Colour of faces, a run of pixels at a time: body colour * texture * light, as far as the
 * samples see it and the real world leaves it. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define NODE_PX 4 /* pixels from one node of light to the next */
#define CHUNK 48  /* pixels between steps: SOFT_LANES nodes reach beyond them */

/* Values of some pixels in a row, between steps. Every step takes a whole number of SOFT_LANES, so
 * that no pixel is left over for slower code. */
typedef struct lanes {
    float z[CHUNK], light[CHUNK], share[CHUNK], coverage[CHUNK];
    float weight_x[CHUNK], weight_y[CHUNK];
    int32_t index[CHUNK];
    uint32_t texels[CHUNK];
} lanes;

/* What other bodies leave of the light around and of the directed light, every NODE_PX pixels. */
typedef struct light_nodes {
    float ambient[SOFT_LANES], direct[SOFT_LANES];
} light_nodes;

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

RLF_KERNEL_PART run run_of(const soft_face *f, const soft_body *body, float x, float y)
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

/* Depths of pixels `step` apart. One that only a corner of the face touches has its centre outside:
 * stay within. */
RLF_KERNEL_PART void interpolate_z(const run *r, int32_t first, int32_t step, int32_t count,
                                   float *restrict out_z)
{
    const ramp inverse_z = r->inverse_z;
    const float low = r->inverse_z_min;
    const float high = r->inverse_z_max;
    for (int32_t i = 0; i < count; i++) {
        float x = (float)(first + step * i);
        out_z[i] = 1.0f / clamp(inverse_z.at0 + inverse_z.step * x, low, high);
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

RLF_KERNEL_PART void look_up(const uint32_t *restrict texture, const int32_t *restrict index,
                             int32_t count, uint32_t *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        out[i] = texture[index[i]];
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

/* The same without an edge near. */
RLF_KERNEL_PART void share_plain(const float *restrict real_z, rlf_kernel_noise noise,
                                 const float *restrict z, int32_t count, float *restrict share)
{
    for (int32_t i = 0; i < count; i++) {
        float here = real_z[i] > 0.0f ? real_z[i] : SILHOUETTE_FAR;
        float fade = 0.25f / rlf_kernel_sigma(noise, z[i]);
        share[i] = clamp(0.5f + (here - z[i]) * fade, 0.0f, 1.0f);
    }
}

RLF_KERNEL_PART bool has_edge(const uint8_t *marks, int32_t x0, int32_t x1)
{
    int32_t any = 0;
    for (int32_t i = x0 / SILHOUETTE_TILE; i * SILHOUETTE_TILE < x1; i++) {
        any |= marks[i] & SILHOUETTE_EDGE;
    }
    return any != 0;
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

/* ---- sums ----------------------------------------------------------------------------------- */

/* Share of the samples that see the face. */
RLF_KERNEL_PART void cover(const int32_t *restrict face, ptrdiff_t stride, int32_t id,
                           int32_t count, float *restrict coverage)
{
    const int32_t *restrict second = face + stride;
    const int32_t *restrict third = face + 2 * stride;
    const int32_t *restrict fourth = face + 3 * stride;
    for (int32_t i = 0; i < count; i++) {
        float a = face[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float b = second[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float c = third[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float d = fourth[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        coverage[i] = (a + b) + (c + d);
    }
}

/* `share` of the light shown, with what the real world leaves of it. */
RLF_KERNEL_PART void take_share(const float *restrict coverage, int32_t count,
                                float *restrict share, float *restrict light)
{
    for (int32_t i = 0; i < count; i++) {
        float shown = share[i] * coverage[i];
        share[i] = shown;
        light[i] *= shown;
    }
}

RLF_KERNEL_PART void add(const float *restrict values, float scale, int32_t count,
                         float *restrict sum)
{
    for (int32_t i = 0; i < count; i++) {
        sum[i] += scale * values[i];
    }
}

/* ---- what takes light from a body ----------------------------------------------------------- */

/* Light between the nodes: linear. */
RLF_KERNEL_PART void apply_light(const float *restrict ambient, const float *restrict direct,
                                 int32_t count, float *restrict light)
{
    const float base = (float)BODY_LIGHT_AMBIENT;
    for (int32_t k = 0; k < count / NODE_PX; k++) {
        const float ambient_step = (ambient[k + 1] - ambient[k]) * (1.0f / NODE_PX);
        const float direct_step = (direct[k + 1] - direct[k]) * (1.0f / NODE_PX);
        float *restrict cell = light + NODE_PX * k;
        for (int32_t i = 0; i < NODE_PX; i++) {
            float ambient_left = ambient[k] + ambient_step * (float)i;
            float direct_left = direct[k] + direct_step * (float)i;
            cell[i] = base * ambient_left + (cell[i] - base) * direct_left;
        }
    }
}

/* A ball about some pixels of a row, from their first and last depth. */
RLF_KERNEL_PART float ball_of(const caster_points *points, int32_t last, float out[3])
{
    float z[2] = {points->z[0], points->z[last]};
    float x[2] = {points->x[0] * z[0], points->x[last] * z[1]};
    float y[2] = {points->y[0] * z[0], points->y[0] * z[1]};
    out[0] = 0.5f * (x[0] + x[1]);
    out[1] = 0.5f * (y[0] + y[1]);
    out[2] = 0.5f * (z[0] + z[1]);
    float step[3] = {x[0] - out[0], y[0] - out[1], z[0] - out[2]};
    return sqrtf(step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
}

/* Other bodies' contact darkening takes the light around, their shadows the directed light: at
 * nodes from (x, y) on, of which `count` pixels will be drawn. False when no body takes any. */
RLF_KERNEL_PART bool fill_nodes(const soft *s, const soft_face *f, int32_t x, int32_t y,
                                int32_t count, light_nodes *out)
{
    const soft_body *body = &s->scene.bodies[f->body];
    const run r = run_of(f, body, (float)x, (float)y);
    float ray_x[SOFT_LANES];
    float ray_y[SOFT_LANES];
    float z[SOFT_LANES];
    const float first = s->ray_x0 + s->ray_step_x * (float)x;
    const float down = s->ray_y0 + s->ray_step_y * (float)y;
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        ray_x[i] = first + s->ray_step_x * (float)(NODE_PX * i);
        ray_y[i] = down;
        out->ambient[i] = 1.0f;
        out->direct[i] = 1.0f;
    }
    interpolate_z(&r, 0, NODE_PX, SOFT_LANES, z);
    const caster_points points = {ray_x, ray_y, z, SOFT_LANES};
    float middle[3];
    float radius = ball_of(&points, (count + NODE_PX - 1) / NODE_PX, middle);
    int32_t any = CASTER_TAKES_NOTHING;
    for (int32_t i = 0; i < body->shader_count; i++) {
        const caster *c = &s->scene.casters[body->shaders[i]];
        int32_t takes = caster_may_take(c, s->light, middle, radius);
        any |= takes;
        if ((takes & CASTER_TAKES_AMBIENT) != 0) {
            caster_take_ambient(c, &points, (float)BODY_AMBIENT_SHARE, out->ambient);
        }
        if ((takes & CASTER_TAKES_DIRECT) != 0) {
            caster_take_direct(c, &points, (float)BODY_DIRECT_SHARE, out->direct);
        }
    }
    return any != CASTER_TAKES_NOTHING;
}

/* Nodes of the row at `share` of the way from the first to the last one. */
RLF_KERNEL_PART void mix_nodes(const light_nodes *first, const light_nodes *last, float share,
                               light_nodes *out)
{
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out->ambient[i] = first->ambient[i] + (last->ambient[i] - first->ambient[i]) * share;
        out->direct[i] = first->direct[i] + (last->direct[i] - first->direct[i]) * share;
    }
}

/* ---- runs ----------------------------------------------------------------------------------- */

/* Pixels x .. x + count of a row; nodes NULL = no light is taken. */
RLF_KERNEL_PART void shade_run(const soft *s, const soft_face *f, int32_t id, const soft_row *row,
                               ptrdiff_t stride, int32_t x, int32_t used, const light_nodes *nodes,
                               int32_t first_node)
{
    const soft_body *body = &s->scene.bodies[f->body];
    const soft_real_row *real = &row->real;
    const run r = run_of(f, body, (float)x, (float)row->y);
    const int32_t count = (used + SOFT_LANES - 1) / SOFT_LANES * SOFT_LANES;
    lanes v;
    interpolate_z(&r, 0, 1, count, v.z);
    interpolate_light(&r, 0, count, v.z, v.light);
    if (nodes != NULL) {
        apply_light(nodes->ambient + first_node, nodes->direct + first_node, count, v.light);
    }
    interpolate_uv(&r, 0, count, v.z, v.weight_x, v.weight_y, v.index);
    look_up(body->texture, v.index, count, v.texels);
    filter(v.texels, v.weight_x, v.weight_y, count, v.light);
    if (real->marks != NULL && !has_edge(real->marks, x, x + used)) {
        share_plain(real->row + x, real->noise, v.z, count, v.share);
    } else if (real->marks != NULL) {
        share_soft(real->near_z + x, real->far_z + x, real->cover + x, real->noise, v.z, count,
                   v.share);
    } else if (real->row != NULL) {
        share_hard(real, x, count, &v);
    } else {
        share_all(count, v.share);
    }
    cover(row->face + x, stride, id, count, v.coverage);
    take_share(v.coverage, count, v.share, v.light);
    for (int k = 0; k < 3; k++) {
        add(v.light, body->color[k], count, row->sum[k] + x);
    }
    add(v.share, 1.0f, count, row->sum[3] + x);
    add(v.coverage, 1.0f, count, row->sum[4] + x);
}

/* Pixels of row i that the face may be seen in. */
RLF_KERNEL_PART soft_span span_of(const soft_ends *ends, int32_t i)
{
    soft_span span = {INT32_MAX, 0};
    for (int32_t k = SOFT_SAMPLES * i; k < SOFT_SAMPLES * (i + 1); k++) {
        bool is_some = ends->begin[k] < ends->end[k];
        span.x0 = is_some && ends->begin[k] < span.x0 ? ends->begin[k] : span.x0;
        span.x1 = is_some && ends->end[k] > span.x1 ? ends->end[k] : span.x1;
    }
    return span;
}

/* Columns x .. x + CHUNK of all rows: light is taken at the nodes of the first and the last row. */
RLF_KERNEL_PART void shade_chunk(const soft *s, const soft_ends *ends, const soft_group *group,
                                 const soft_span *spans, int32_t x)
{
    const soft_face *f = &s->scene.faces[ends->face];
    const int32_t last = group->row_count - 1;
    light_nodes nodes[3];
    bool is_shaded = false;
    if (s->scene.bodies[f->body].shader_count > 0) {
        is_shaded = fill_nodes(s, f, x, group->rows[0].y, CHUNK, &nodes[0]);
        is_shaded = fill_nodes(s, f, x, group->rows[last].y, CHUNK, &nodes[1]) || is_shaded;
    }
    for (int32_t i = 0; i <= last; i++) {
        int32_t x0 = spans[i].x0 > x ? (spans[i].x0 - x) / NODE_PX * NODE_PX + x : x;
        int32_t x1 = spans[i].x1 < x + CHUNK ? spans[i].x1 : x + CHUNK;
        if (x0 < x1) {
            if (is_shaded) {
                mix_nodes(&nodes[0], &nodes[1], last > 0 ? (float)i / (float)last : 0.0f,
                          &nodes[2]);
            }
            shade_run(s, f, ends->face, &group->rows[i], group->stride, x0, x1 - x0,
                      is_shaded ? &nodes[2] : NULL, (x0 - x) / NODE_PX);
        }
    }
}

RLF_KERNEL void soft_shade_face(const soft *s, const soft_ends *ends, const soft_group *group)
{
    soft_span spans[SOFT_GROUP_ROWS];
    soft_span all = {INT32_MAX, 0};
    for (int32_t i = 0; i < group->row_count; i++) {
        spans[i] = span_of(ends, i);
        all.x0 = spans[i].x0 < all.x0 ? spans[i].x0 : all.x0;
        all.x1 = spans[i].x1 > all.x1 ? spans[i].x1 : all.x1;
    }
    for (int32_t x = all.x0; x < all.x1; x += CHUNK) {
        shade_chunk(s, ends, group, spans, x);
    }
}
