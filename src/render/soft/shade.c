/* Pixels of faces that samples see, with what is linear in the picture there: into a stream. */
#include "render/soft/passes.h"

#include "kernel/kernel.h"
#include "render/soft/stream.h"
#include "render/soft/soft.h"

/* Of a row of a face from pixel x on. */
typedef struct run {
    ramp inverse_z, attribute[SOFT_ATTRIBUTES];
    float inverse_z_min, inverse_z_max;
} run;

RLF_KERNEL_PART run run_of(const soft_face *f, float x, float y)
{
    float dx = x - f->origin_x;
    float dy = y - f->origin_y;
    run r = {.inverse_z = ramp_at(&f->inverse_z, dx, dy),
             .inverse_z_min = f->inverse_z_min,
             .inverse_z_max = f->inverse_z_max};
    for (int i = 0; i < SOFT_ATTRIBUTES; i++) {
        r.attribute[i] = ramp_at(&f->attribute[i], dx, dy);
    }
    return r;
}

/* What is being drawn. */
typedef struct shading {
    const soft *s;
    const soft_group *group;
    const soft_face *face;
    const soft_ends *ends;   /* of it */
    int32_t id;              /* of the face */
    soft_depth_range fading; /* what is real between hides some of it, what is nearer all */
    soft_stream *stream;
} shading;

/* Share of the samples that see the face, in the first `used` lanes; else 0. False when none does.
 */
RLF_KERNEL_PART bool cover(const int32_t *restrict face, ptrdiff_t stride, int32_t id, int32_t used,
                           float *restrict coverage)
{
    const int32_t *restrict second = face + stride;
    const int32_t *restrict third = face + 2 * stride;
    const int32_t *restrict fourth = face + 3 * stride;
    int32_t any = 0;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        int32_t seen = (face[i] == id ? 1 : 0) + (second[i] == id ? 1 : 0) +
                       (third[i] == id ? 1 : 0) + (fourth[i] == id ? 1 : 0);
        seen = i < used ? seen : 0;
        coverage[i] = (float)seen * (1.0f / SOFT_SAMPLES);
        any |= seen;
    }
    return any != 0;
}

/* The same for a face that is alone, whose lines begin and end here: lanes from pixel x on. */
RLF_KERNEL_PART void cover_alone(const int32_t begin[SOFT_SAMPLES], const int32_t end[SOFT_SAMPLES],
                                 int32_t x, int32_t used, float *restrict coverage)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        const int32_t at = x + i;
        int32_t seen = (at >= begin[0] ? 1 : 0) & (at < end[0] ? 1 : 0);
        seen += (at >= begin[1] ? 1 : 0) & (at < end[1] ? 1 : 0);
        seen += (at >= begin[2] ? 1 : 0) & (at < end[2] ? 1 : 0);
        seen += (at >= begin[3] ? 1 : 0) & (at < end[3] ? 1 : 0);
        seen = i < used ? seen : 0;
        coverage[i] = (float)seen * (1.0f / SOFT_SAMPLES);
    }
}

/* Share of the face's samples that it wins in lanes from pixel x of a row on, as above. */
RLF_KERNEL_PART bool cover_lanes(const shading *job, int32_t row, int32_t x, int32_t used,
                                 float *restrict coverage)
{
    const soft_ends *ends = job->ends;
    const int32_t first = SOFT_SAMPLES * row;
    if (ends->is_alone) {
        cover_alone(ends->begin + first, ends->end + first, x, used, coverage);
        return true;
    }
    return cover(job->group->rows[row].face + x, job->group->stride, job->id, used, coverage);
}

/* One that only a corner of the face touches has its centre outside: stay within. */
RLF_KERNEL_PART void fill_inverse_z(const run *r, int32_t first, float *restrict out)
{
    const ramp inverse_z = r->inverse_z;
    const float low = r->inverse_z_min;
    const float high = r->inverse_z_max;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out[i] = stream_clamp(inverse_z.at0 + inverse_z.step * (float)(first + i), low, high);
    }
}

RLF_KERNEL_PART void fill_ramp(const ramp r, int32_t first, float *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out[i] = r.at0 + r.step * (float)(first + i);
    }
}

/* Between nodes `px` pixels apart, a multiple of 4: linear. */
RLF_KERNEL_PART void fill_left(const float *restrict nodes, int32_t px, float *restrict out)
{
    const float per_px = 1.0f / (float)px;
    for (int32_t k = 0; k < SOFT_LANES; k += 4) {
        const int32_t node = k / px;
        const float step = (nodes[node + 1] - nodes[node]) * per_px;
        for (int32_t i = 0; i < 4; i++) {
            out[k + i] = nodes[node] + step * (float)(k - node * px + i);
        }
    }
}

RLF_KERNEL_PART void fill_all(float value, float *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        out[i] = value;
    }
}

/* Light that is left in lanes `at` and on, from node `node` on; nodes NULL = all. */
RLF_KERNEL_PART void fill_light(const light_nodes *nodes, int32_t node, int32_t px, int32_t at,
                                soft_stream *v)
{
    if (nodes == NULL) {
        fill_all(1.0f, v->ambient + at);
        fill_all(1.0f, v->direct + at);
    } else if (px == 4) {
        fill_left(nodes->ambient + node, 4, v->ambient + at);
        fill_left(nodes->direct + node, 4, v->direct + at);
    } else {
        fill_left(nodes->ambient + node, 8, v->ambient + at);
        fill_left(nodes->direct + node, 8, v->direct + at);
    }
}

/* Adds `used` pixels of a row from x on, but for those that other faces are before. */
RLF_KERNEL_PART void shade_run(const shading *job, int32_t row_index, int32_t x, int32_t used,
                               const light_nodes *nodes, int32_t first_node)
{
    const soft_row *row = &job->group->rows[row_index];
    const run r = run_of(job->face, (float)x, (float)row->y);
    const int32_t px = job->s->shade_px;
    soft_stream *v = job->stream;
    for (int32_t i = 0; i < used; i += SOFT_LANES) {
        const int32_t count = used - i < SOFT_LANES ? used - i : SOFT_LANES;
        if (v->count + SOFT_LANES > STREAM_LANES) {
            soft_stream_flush(job->s, job->group, v);
        }
        const int32_t at = v->count;
        if (cover_lanes(job, row_index, x + i, count, v->coverage + at)) {
            fill_inverse_z(&r, i, v->z + at);
            for (int k = 0; k < 3; k++) {
                fill_ramp(r.attribute[SOFT_NORMAL + k], i, v->n[k] + at);
            }
            const ramp ray = {job->s->ray_x0 + job->s->ray_step_x * (float)x, job->s->ray_step_x};
            fill_ramp(ray, i, v->ray_x + at);
            fill_all(job->s->ray_y0 + job->s->ray_step_y * (float)row->y, v->ray_y + at);
            fill_ramp(r.attribute[SOFT_S], i, v->s + at);
            fill_ramp(r.attribute[SOFT_T], i, v->t + at);
            fill_light(nodes, first_node + i / px, px, at, v);
            fill_all(v->material.metallic, v->metallic + at);
            fill_all(v->material.roughness, v->roughness + at);
            v->segments[v->segment_count++] =
                (stream_segment){row_index, x + i, count, at, job->id, job->fading.far_z};
            v->count += count;
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

/* True when what is real hides all of columns [x, end). */
RLF_KERNEL_PART bool is_hidden(const shading *job, int32_t x, int32_t end)
{
    const soft_real_row *real = &job->group->rows[0].real;
    int32_t shown = real->tiles == NULL ? 1 : 0;
    for (int32_t i = x / EDGE_MATTE_TILE; shown == 0 && i * EDGE_MATTE_TILE < end; i++) {
        shown |= real->tiles[i].far_z > job->fading.near_z ? 1 : 0;
    }
    return shown == 0;
}

/* Columns x .. x + count of all rows: light is taken at the nodes of the first and the last row. */
RLF_KERNEL_PART void shade_chunk(const shading *job, const soft_span *spans, int32_t x,
                                 int32_t count)
{
    const soft *s = job->s;
    const soft_body *body = job->stream->body;
    const int32_t last = job->group->row_count - 1;
    const int32_t y[2] = {job->group->rows[0].y, job->group->rows[last].y};
    light_nodes nodes;
    light_nodes mixed;
    if (is_hidden(job, x, x + count)) {
        return;
    }
    bool may_be = body->shader_count > 0 || body->real_shade != NULL || body->obscurance != NULL;
    bool is_shaded = may_be && soft_fill_nodes(s, job->face, y, x, count, &nodes);
    const int32_t align = is_shaded ? s->shade_px : 1;
    for (int32_t i = 0; i <= last; i++) {
        int32_t x0 = spans[i].x0 > x ? (spans[i].x0 - x) / align * align + x : x;
        int32_t x1 = spans[i].x1 < x + count ? spans[i].x1 : x + count;
        if (x0 < x1) {
            if (is_shaded) {
                mix_nodes(&nodes, last > 0 ? (float)i / (float)last : 0.0f, &mixed);
            }
            shade_run(job, i, x0, x1 - x0, is_shaded ? &mixed : NULL, (x0 - x) / s->shade_px);
        }
    }
}

RLF_KERNEL_PART void shade_face(const shading *job)
{
    const soft_ends *ends = job->ends;
    soft_span spans[SOFT_GROUP_ROWS];
    for (int32_t i = 0; i < job->group->row_count; i++) {
        spans[i] = span_of(ends, i);
    }
    const int32_t chunk = CHUNK_NODES * job->s->shade_px;
    for (int32_t x = ends->x0; x < ends->x1; x += chunk) {
        shade_chunk(job, spans, x, ends->x1 - x < chunk ? ends->x1 - x : chunk);
    }
}

/* Where what is real hides nothing of a face, and where all: 2 sigma behind and before it, the most
 * that sigma may be anywhere on it. */
RLF_KERNEL_PART soft_depth_range fading_range(const soft_face *f, const soft_real_row *real)
{
    const rlf_kernel_noise n = real->noise;
    const float near_z = 1.0f / f->inverse_z_max;
    const float far_z = 1.0f / f->inverse_z_min;
    const float linear = n.c1 > 0.0f ? n.c1 * far_z : n.c1 * near_z;
    const float square = n.c2 > 0.0f ? n.c2 * far_z * far_z : n.c2 * near_z * near_z;
    const float sigma = n.c0 + linear + square;
    const float reach = 2.001f * (sigma > 0.0003f ? sigma : 0.0003f);
    const soft_depth_range range = {0.9999f * near_z - reach, 1.0001f * far_z + reach};
    return range;
}

/* Of a model's face. Where normals turn much within a pixel it mirrors what they all do, as a
 * rougher one does: Kaplanyan, Hill, Patney and Lefohn 2016. */
static probe_material material_of(const soft_face *f, probe_material material)
{
    const float z = 1.0f / f->inverse_z.at0;
    float turn = 0.0f;
    for (int k = SOFT_NORMAL; k < SOFT_NORMAL + 3; k++) {
        const float n = f->attribute[k].at0 * z;
        const float dx = (f->attribute[k].dx - n * f->inverse_z.dx) * z;
        const float dy = (f->attribute[k].dy - n * f->inverse_z.dy) * z;
        turn += 0.25f * (dx * dx + dy * dy);
    }
    turn = turn < PROBE_TURN ? turn : PROBE_TURN;
    const float square = material.roughness * material.roughness;
    if (turn > 1e-3f) {
        material.roughness = sqrtf(sqrtf(square * square + turn));
    }
    return material;
}

RLF_KERNEL void soft_shade_faces(const soft *s, const soft_ends *ends, int32_t count,
                                 const soft_group *group)
{
    soft_stream stream;
    stream.body = NULL;
    stream.count = stream.segment_count = 0;
    for (int32_t i = 0; i < count; i++) {
        const int32_t id = ends[i].face;
        const soft_face *face = &s->scene.faces[id];
        const soft_body *body = &s->scene.bodies[face->body];
        const bool has_skin = face->skin > 0;
        if (stream.body != body || stream.has_skin != has_skin) {
            if (stream.count > 0) {
                soft_stream_flush(s, group, &stream);
            }
            stream.body = body;
            stream.has_skin = has_skin;
        }
        stream.material =
            has_skin ? material_of(face, s->scene.skins[face->skin].material) : body->material;
        const shading job = {
            s, group, face, &ends[i], id, fading_range(face, &group->rows[0].real), &stream};
        shade_face(&job);
    }
    if (stream.count > 0) {
        soft_stream_flush(s, group, &stream);
    }
}
