/* Colour of faces, SOFT_LANES pixels at a time: body colour * texture * light, as far as the
 * samples see it and the real world leaves it. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

/* Light is taken at nodes 4 or 8 pixels apart (soft.shade_px): of a row so many, or half. */
#define ROW_NODES SOFT_LANES
#define CHUNK_NODES                                                                                \
    12 /* pixels of so many nodes are drawn at a time: the last block needs more                   \
        */

/* Values of some pixels in a row, between steps. */
typedef struct lanes {
    float z[SOFT_LANES], light[SOFT_LANES], share[SOFT_LANES], coverage[SOFT_LANES];
    float weight_x[SOFT_LANES], weight_y[SOFT_LANES];
    int32_t index[SOFT_LANES];
    uint32_t texels[SOFT_LANES];
} lanes;

/* What other bodies leave of the light around and of the directed light: `per_row` nodes of one
 * row, then of another. */
typedef struct light_nodes {
    int32_t per_row;
    float ambient[2 * ROW_NODES], direct[2 * ROW_NODES];
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
RLF_KERNEL_PART void interpolate_z(const run *r, int32_t first, int32_t step, float *restrict out_z)
{
    const ramp inverse_z = r->inverse_z;
    const float low = r->inverse_z_min;
    const float high = r->inverse_z_max;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float x = (float)(first + step * i);
        out_z[i] = 1.0f / clamp(inverse_z.at0 + inverse_z.step * x, low, high);
    }
}

RLF_KERNEL_PART void interpolate_light(const run *r, int32_t first, const float *restrict z,
                                       float *restrict out_light)
{
    const ramp light = r->attribute[SOFT_LIGHT];
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out_light[i] = clamp((light.at0 + light.step * (float)(first + i)) * z[i], 0.0f, 1.0f);
    }
}

/* Texel and weights of the next one across and down. */
RLF_KERNEL_PART void interpolate_uv(const run *r, int32_t first, const float *restrict z,
                                    float *restrict weight_x, float *restrict weight_y,
                                    int32_t *restrict index)
{
    const ramp across = r->attribute[SOFT_S];
    const ramp down = r->attribute[SOFT_T];
    const float size = r->texture_size;
    const int32_t mask = r->mask;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
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
                             uint32_t *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out[i] = texture[index[i]];
    }
}

/* Bilinear: the four neighbours are the bytes of one texel. */
RLF_KERNEL_PART void filter(const uint32_t *restrict texels, const float *restrict weight_x,
                            const float *restrict weight_y, float *restrict light)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
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
                                const float *restrict z, float *restrict share)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float fade = 0.25f / rlf_kernel_sigma(noise, z[i]);
        float near_share = clamp(0.5f + (near_z[i] - z[i]) * fade, 0.0f, 1.0f);
        float far_share = clamp(0.5f + (far_z[i] - z[i]) * fade, 0.0f, 1.0f);
        float part = (float)cover[i] * (1.0f / 255.0f);
        share[i] = far_share + (near_share - far_share) * part;
    }
}

/* The same without an edge near. */
RLF_KERNEL_PART void share_plain(const float *restrict real_z, rlf_kernel_noise noise,
                                 const float *restrict z, float *restrict share)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
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
RLF_KERNEL_PART void share_hard(const soft_real_row *real, int32_t x, lanes *v)
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
            shown -= taps[k] > 0.0f && taps[k] < v->z[i] ? (k == 0 ? 2 : 1) : 0;
        }
        v->share[i] = (float)shown * (1.0f / 6.0f);
    }
}

RLF_KERNEL_PART void share_all(float *restrict share)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        share[i] = 1.0f;
    }
}

/* ---- sums ----------------------------------------------------------------------------------- */

/* Share of the samples that see the face, in the first `used` lanes; else 0. */
RLF_KERNEL_PART void cover(const int32_t *restrict face, ptrdiff_t stride, int32_t id, int32_t used,
                           float *restrict coverage)
{
    const int32_t *restrict second = face + stride;
    const int32_t *restrict third = face + 2 * stride;
    const int32_t *restrict fourth = face + 3 * stride;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float a = face[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float b = second[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float c = third[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float d = fourth[i] == id ? 1.0f / SOFT_SAMPLES : 0.0f;
        float all = (a + b) + (c + d);
        coverage[i] = i < used ? all : 0.0f;
    }
}

RLF_KERNEL_PART bool is_any(const float *restrict coverage)
{
    float sum = 0.0f;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        sum += coverage[i];
    }
    return sum > 0.0f;
}

/* `share` of the light shown, with what the real world leaves of it. */
RLF_KERNEL_PART void take_share(const float *restrict coverage, float *restrict share,
                                float *restrict light)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float shown = share[i] * coverage[i];
        share[i] = shown;
        light[i] *= shown;
    }
}

RLF_KERNEL_PART void add(const float *restrict values, float scale, float *restrict sum)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        sum[i] += scale * values[i];
    }
}

/* ---- what takes light from a body ----------------------------------------------------------- */

/* Light between nodes `px` pixels apart, a multiple of 4: linear. */
RLF_KERNEL_PART void apply_light(const float *restrict ambient, const float *restrict direct,
                                 int32_t px, float *restrict light)
{
    const float base = (float)BODY_LIGHT_AMBIENT;
    const float per_px = 1.0f / (float)px;
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < SOFT_LANES; k += 4) {
        const int32_t node = k / px;
        const float ambient_step = (ambient[node + 1] - ambient[node]) * per_px;
        const float direct_step = (direct[node + 1] - direct[node]) * per_px;
        float *restrict cell = light + k;
        for (int32_t i = 0; i < 4; i++) {
            const float from = (float)(k - node * px + i);
            float ambient_left = ambient[node] + ambient_step * from;
            float direct_left = direct[node] + direct_step * from;
            cell[i] = base * ambient_left + (cell[i] - base) * direct_left;
        }
    }
}

/* A ball about four corners. */
RLF_KERNEL_PART float ball_of(const caster_points *points, const int32_t corner[4], float out[3])
{
    float p[4][3];
    out[0] = out[1] = out[2] = 0.0f;
    for (int i = 0; i < 4; i++) {
        const float z = points->z[corner[i]];
        p[i][0] = points->x[corner[i]] * z;
        p[i][1] = points->y[corner[i]] * z;
        p[i][2] = z;
        for (int k = 0; k < 3; k++) {
            out[k] += 0.25f * p[i][k];
        }
    }
    float most = 0.0f;
    for (int i = 0; i < 4; i++) {
        float step[3] = {p[i][0] - out[0], p[i][1] - out[1], p[i][2] - out[2]};
        float square = step[0] * step[0] + step[1] * step[1] + step[2] * step[2];
        most = square > most ? square : most;
    }
    return sqrtf(most);
}

/* Depths of the nodes of a row from pixel (x, y) on, and their rays. */
RLF_KERNEL_PART void place_nodes(const soft *s, const soft_face *f, int32_t x, int32_t y,
                                 float *restrict ray_x, float *restrict ray_y, float *restrict z)
{
    const run r = run_of(f, &s->scene.bodies[f->body], (float)x, (float)y);
    const float first = s->ray_x0 + s->ray_step_x * (float)x;
    const float step = s->ray_step_x * (float)s->shade_px;
    const float down = s->ray_y0 + s->ray_step_y * (float)y;
    interpolate_z(&r, 0, s->shade_px, z);
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        ray_x[i] = first + step * (float)i;
        ray_y[i] = down;
    }
}

RLF_KERNEL_PART void clear_nodes(light_nodes *out)
{
    RLF_KERNEL_WHOLE
    for (int32_t k = 0; k < 2 * ROW_NODES; k++) {
        out->ambient[k] = out->direct[k] = 1.0f;
    }
}

/* Other bodies' contact darkening takes the light around, their shadows the directed light: at
 * nodes of rows y0 and y1 from x on, of which `count` pixels will be drawn. So do real things.
 * False when nothing takes any. */
RLF_KERNEL_PART bool fill_nodes(const soft *s, const soft_face *f, const int32_t y[2], int32_t x,
                                int32_t count, light_nodes *out)
{
    const soft_body *body = &s->scene.bodies[f->body];
    float ray_x[2 * ROW_NODES];
    float ray_y[2 * ROW_NODES];
    float z[2 * ROW_NODES];
    const int32_t last = (count + s->shade_px - 1) / s->shade_px;
    const int32_t per_row = last < ROW_NODES / 2 ? ROW_NODES / 2 : ROW_NODES;
    for (int32_t i = 0; i < 2; i++) {
        const int32_t first = i * per_row;
        place_nodes(s, f, x, y[i], ray_x + first, ray_y + first, z + first);
    }
    const caster_points points = {ray_x, ray_y, z, 2 * per_row};
    const int32_t corner[4] = {0, last, per_row, per_row + last};
    out->per_row = per_row;
    float middle[3];
    float radius = ball_of(&points, corner, middle);
    bool is_shaded = body->real_shade != NULL;
    if (is_shaded) {
        clear_nodes(out);
        real_shade_take(body->real_shade, &points, (float)BODY_DIRECT_SHARE, out->direct);
    }
    for (int32_t i = 0; i < body->shader_count; i++) {
        const caster *c = &s->scene.casters[body->shaders[i]];
        int32_t takes = caster_may_take(c, s->light, middle, radius);
        if (takes != CASTER_TAKES_NOTHING && !is_shaded) {
            clear_nodes(out);
        }
        is_shaded = is_shaded || takes != CASTER_TAKES_NOTHING;
        if ((takes & CASTER_TAKES_AMBIENT) != 0) {
            caster_take_ambient(c, &points, (float)BODY_AMBIENT_SHARE, out->ambient);
        }
        if ((takes & CASTER_TAKES_DIRECT) != 0) {
            caster_take_direct(c, &points, (float)BODY_DIRECT_SHARE, out->direct);
        }
    }
    return is_shaded;
}

/* Nodes of a row at `share` of the way from the first to the other one, into `out`'s first row.
 * Those beyond per_row are of no use, but numbers. */
RLF_KERNEL_PART void mix_nodes(const light_nodes *nodes, float share, light_nodes *out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float ambient = nodes->ambient[i];
        float direct = nodes->direct[i];
        out->ambient[i] = ambient + (nodes->ambient[nodes->per_row + i] - ambient) * share;
        out->direct[i] = direct + (nodes->direct[nodes->per_row + i] - direct) * share;
    }
}

/* ---- runs ----------------------------------------------------------------------------------- */

/* SOFT_LANES pixels of a row; nodes NULL = no light is taken. */
RLF_KERNEL_PART void shade_block(const soft_body *body, bool has_skin, const run *r, int32_t first,
                                 const light_nodes *nodes, int32_t node, int32_t px, lanes *v)
{
    interpolate_z(r, first, 1, v->z);
    interpolate_light(r, first, v->z, v->light);
    if (nodes != NULL && px == 4) {
        apply_light(nodes->ambient + node, nodes->direct + node, 4, v->light);
    } else if (nodes != NULL) {
        apply_light(nodes->ambient + node, nodes->direct + node, 8, v->light);
    }
    if (!has_skin) {
        interpolate_uv(r, first, v->z, v->weight_x, v->weight_y, v->index);
        look_up(body->texture, v->index, v->texels);
        filter(v->texels, v->weight_x, v->weight_y, v->light);
    }
}

RLF_KERNEL_PART void multiply(const float *restrict values, float *restrict by)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        by[i] *= values[i];
    }
}

/* Adds light of a model's face, as its skin shows it, to the row's sums. */
RLF_KERNEL_PART void add_skin(const soft_skin *skin, const soft_face *f, soft_lanes_at at,
                              const lanes *v, const soft_row *row)
{
    float rgb[3][SOFT_LANES];
    if (skin->texture == NULL) {
        for (int k = 0; k < 3; k++) {
            add(v->light, skin->color[k], row->sum[k] + at.x);
        }
        return;
    }
    soft_skin_colors(skin, f, at, v->z, rgb);
    for (int k = 0; k < 3; k++) {
        multiply(v->light, rgb[k]);
        add(rgb[k], skin->color[k], row->sum[k] + at.x);
    }
}

/* Adds `used` pixels of a row from x on. */
RLF_KERNEL_PART void shade_run(const soft *s, const soft_ends *ends, const soft_group *group,
                               const soft_row *row, int32_t x, int32_t used,
                               const light_nodes *nodes, int32_t first_node)
{
    const soft_face *f = &s->scene.faces[ends->face];
    const soft_body *body = &s->scene.bodies[f->body];
    const soft_real_row *real = &row->real;
    const run r = run_of(f, body, (float)x, (float)row->y);
    lanes v;
    for (int32_t i = 0; i < used; i += SOFT_LANES) {
        const int32_t at = x + i;
        cover(row->face + at, group->stride, ends->face, used - i, v.coverage);
        if (!is_any(v.coverage)) {
            continue; /* other faces are before it */
        }
        shade_block(body, f->skin > 0, &r, i, nodes, first_node + i / s->shade_px, s->shade_px, &v);
        const int32_t end = at + (used - i < SOFT_LANES ? used - i : SOFT_LANES);
        if (real->marks != NULL && !has_edge(real->marks, at, end)) {
            share_plain(real->row + at, real->noise, v.z, v.share);
        } else if (real->marks != NULL) {
            share_soft(real->near_z + at, real->far_z + at, real->cover + at, real->noise, v.z,
                       v.share);
        } else if (real->row != NULL) {
            share_hard(real, at, &v);
        } else {
            share_all(v.share);
        }
        take_share(v.coverage, v.share, v.light);
        if (f->skin > 0) {
            const soft_lanes_at lanes_at = {at, row->y, end - at};
            add_skin(&s->scene.skins[f->skin], f, lanes_at, &v, row);
        } else {
            for (int k = 0; k < 3; k++) {
                add(v.light, body->color[k], row->sum[k] + at);
            }
        }
        add(v.share, 1.0f, row->sum[3] + at);
        if (s->def.occlusion == RLF_OCCLUSION_THESIS) {
            add(v.coverage, 1.0f, row->sum[SOFT_COVERED] + at);
        }
    }
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

/* Columns x .. x + count of all rows: light is taken at the nodes of the first and the last row. */
RLF_KERNEL_PART void shade_chunk(const soft *s, const soft_ends *ends, const soft_group *group,
                                 const soft_span *spans, int32_t x, int32_t count)
{
    const soft_face *f = &s->scene.faces[ends->face];
    const int32_t last = group->row_count - 1;
    const int32_t y[2] = {group->rows[0].y, group->rows[last].y};
    light_nodes nodes;
    light_nodes mixed;
    const soft_body *body = &s->scene.bodies[f->body];
    bool is_shaded = (body->shader_count > 0 || body->real_shade != NULL) &&
                     fill_nodes(s, f, y, x, count, &nodes);
    const int32_t align = is_shaded ? s->shade_px : 1;
    for (int32_t i = 0; i <= last; i++) {
        int32_t x0 = spans[i].x0 > x ? (spans[i].x0 - x) / align * align + x : x;
        int32_t x1 = spans[i].x1 < x + count ? spans[i].x1 : x + count;
        if (x0 < x1) {
            if (is_shaded) {
                mix_nodes(&nodes, last > 0 ? (float)i / (float)last : 0.0f, &mixed);
            }
            shade_run(s, ends, group, &group->rows[i], x0, x1 - x0, is_shaded ? &mixed : NULL,
                      (x0 - x) / s->shade_px);
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
    const int32_t chunk = CHUNK_NODES * s->shade_px;
    for (int32_t x = all.x0; x < all.x1; x += chunk) {
        shade_chunk(s, ends, group, spans, x, all.x1 - x < chunk ? all.x1 - x : chunk);
    }
}
