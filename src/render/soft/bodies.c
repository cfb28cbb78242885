/* Draws the bodies into the picture, row by row: samples first, then colour, then what hides them.
 *
 * RLF_OCCLUSION_DEPTH, SOFT and OFF draw all bodies into one set of samples. RLF_OCCLUSION_THESIS
 * (4.2.2) goes body by body from the far to the near: the body is drawn alone, and where it is (the
 * stencil) the real picture is blended over it where the real depth is less than the body's z, per
 * pixel (errata 8). */
#include "render/soft/passes.h"

#include "render/soft/soft.h"

#include <string.h>

/* The faces of a band of rows, body by body. */
typedef struct band_faces {
    int32_t *faces;
    int32_t count;
} band_faces;

static void list_faces(const soft *s, int32_t begin, int32_t end, bool is_far_first,
                       band_faces *out)
{
    for (int32_t i = 0; i < s->scene.body_count; i++) {
        int32_t index = is_far_first ? s->scene.body_count - 1 - i : i;
        const soft_body *body = &s->scene.bodies[index];
        for (int32_t f = body->first; body->y0 < end && body->y1 > begin && f < body->end; f++) {
            const soft_face *face = &s->scene.faces[f];
            if (face->y_begin < end && face->y_end > begin) {
                out->faces[out->count++] = f;
            }
        }
    }
}

/* Where the band's faces begin and end in the group's rows; returns how many touch it. */
static int32_t find_ends(const soft *s, const band_faces *list, const soft_group *group)
{
    int32_t count = 0;
    int32_t begin = group->rows[0].y;
    for (int32_t i = 0; i < list->count; i++) {
        const soft_face *face = &s->scene.faces[list->faces[i]];
        if (face->y_begin < begin + group->row_count && face->y_end > begin) {
            soft_ends *ends = &group->ends[count];
            ends->face = list->faces[i];
            count += soft_find_ends(face, group, ends) ? 1 : 0;
        }
    }
    return count;
}

/* Draws faces [first, end) of the group into the rows' samples and sums. */
static void draw_faces(const soft *s, int32_t first, int32_t end, soft_group *group)
{
    for (int32_t i = first; i < end; i++) {
        const soft_ends *ends = &group->ends[i];
        soft_raster_face(&s->scene.faces[ends->face], ends, group);
    }
    soft_shade_faces(s, group->ends + first, end - first, group);
}

/* The next run of pixels that are touched alike from part `*part` on; false when there is none. */
static bool next_run(const soft_row *row, int32_t width, int32_t *part, soft_span *out)
{
    while (*part < row->part_count && row->touched[*part] == SOFT_UNTOUCHED) {
        (*part)++;
    }
    out->x0 = *part * SOFT_PART;
    const int32_t touched = *part < row->part_count ? row->touched[*part] : SOFT_UNTOUCHED;
    while (*part < row->part_count && row->touched[*part] == touched) {
        (*part)++;
    }
    out->x1 = *part * SOFT_PART < width ? *part * SOFT_PART : width;
    return touched != SOFT_UNTOUCHED;
}

static void clear_run(const soft_row *row, ptrdiff_t stride, int32_t sums, soft_span t)
{
    size_t count = (size_t)(t.x1 - t.x0);
    const bool has_samples = row->touched[t.x0 / SOFT_PART] == SOFT_TOUCHED;
    for (int k = 0; k < SOFT_SAMPLES && has_samples; k++) {
        memset(row->inverse_z + k * stride + t.x0, 0, count * sizeof(float));
        memset(row->face + k * stride + t.x0, 0, count * sizeof(int32_t));
    }
    for (int k = 0; k < sums; k++) {
        memset(row->sum[k] + t.x0, 0, count * sizeof(float));
    }
}

/* Puts the sums of pixels [t.x0, t.x1) over the picture. */
static void compose(const soft *s, float *const sums[4], int32_t y, soft_span t)
{
    float *const sum[4] = {sums[0] + t.x0, sums[1] + t.x0, sums[2] + t.x0, sums[3] + t.x0};
    soft_compose_row(sum, t.x1 - t.x0, rlf_rgba8_row(&s->image, y) + 4 * (ptrdiff_t)t.x0,
                     rlf_u8_row(&s->matte, y) + t.x0);
}

static void draw_together(const soft *s, int32_t face_count, soft_group *group)
{
    soft_span run;
    draw_faces(s, 0, face_count, group);
    for (int32_t i = 0; i < group->row_count; i++) {
        const soft_row *row = &group->rows[i];
        for (int32_t part = 0; next_run(row, group->width, &part, &run);) {
            compose(s, row->sum, row->y, run);
            clear_run(row, group->stride, SOFT_COVERED, run);
        }
        memset(row->touched, 0, (size_t)row->part_count);
    }
}

/* One body over the layers behind it: inside its silhouette they are gone, behind the body or
 * behind the real picture that is drawn over it. */
static void add_layer(const soft_row *row, soft_span t)
{
    for (int k = 0; k < 4; k++) {
        float *layer = row->layer[k];
        for (int32_t x = t.x0; x < t.x1; x++) {
            layer[x] = layer[x] * (1.0f - row->sum[SOFT_COVERED][x]) + row->sum[k][x];
        }
    }
}

/* Puts one body's sums over the layers; widens `all` by what it touched. */
static void add_layers(const soft_group *group, soft_span all[SOFT_GROUP_ROWS])
{
    soft_span run;
    for (int32_t i = 0; i < group->row_count; i++) {
        const soft_row *row = &group->rows[i];
        for (int32_t part = 0; next_run(row, group->width, &part, &run);) {
            add_layer(row, run);
            clear_run(row, group->stride, SOFT_SUMS, run);
            all[i].x0 = run.x0 < all[i].x0 ? run.x0 : all[i].x0;
            all[i].x1 = run.x1 > all[i].x1 ? run.x1 : all[i].x1;
        }
        memset(row->touched, 0, (size_t)row->part_count);
    }
}

static void draw_layers(const soft *s, int32_t face_count, soft_group *group)
{
    soft_span all[SOFT_GROUP_ROWS];
    for (int32_t i = 0; i < group->row_count; i++) {
        all[i] = (soft_span){INT32_MAX, 0};
    }
    for (int32_t first = 0; first < face_count;) {
        int32_t body = s->scene.faces[group->ends[first].face].body;
        int32_t end = first;
        while (end < face_count && s->scene.faces[group->ends[end].face].body == body) {
            end++;
        }
        draw_faces(s, first, end, group);
        add_layers(group, all);
        first = end;
    }
    for (int32_t i = 0; i < group->row_count; i++) {
        const soft_row *row = &group->rows[i];
        if (all[i].x0 < all[i].x1) {
            compose(s, row->layer, row->y, all[i]);
            for (int k = 0; k < 4; k++) {
                memset(row->layer[k] + all[i].x0, 0,
                       (size_t)(all[i].x1 - all[i].x0) * sizeof(float));
            }
        }
    }
}

typedef struct draw_job {
    const soft *s;
    bool with_background;
} draw_job;

/* What may hide a body in row y. */
static soft_real_row real_row(const soft *s, const soft_depth_range *tiles, int32_t y)
{
    soft_real_row real = {.width = s->camera.width};
    if (s->def.occlusion == RLF_OCCLUSION_OFF) {
        return real;
    }
    int32_t last = s->camera.height - 1;
    real.row = rlf_f32_row(&s->real.z, y);
    real.above = rlf_f32_row(&s->real.z, y > 0 ? y - 1 : y);
    real.below = rlf_f32_row(&s->real.z, y < last ? y + 1 : y);
    if (s->def.occlusion == RLF_OCCLUSION_SOFT) {
        real.near_z = rlf_f32_row(&s->edges.near_z, y);
        real.far_z = rlf_f32_row(&s->edges.far_z, y);
        real.cover = rlf_u8_row(&s->edges.cover, y);
        real.marks = s->edges.marks + y / EDGE_MATTE_TILE * s->edges.columns;
        real.tiles = tiles;
        real.noise = rlf_kernel_noise_make(&s->def.rig.noise);
    }
    return real;
}

RLF_KERNEL_PART float here_or_far(float z)
{
    return z > 0.0f ? z : EDGE_MATTE_FAR;
}

/* Depths of pixels [x0, x0 + EDGE_MATTE_TILE) of rows [begin, end). */
RLF_KERNEL_PART soft_depth_range range_of(const rlf_plane_f32 *near_z, const rlf_plane_f32 *far_z,
                                          int32_t x0, int32_t begin, int32_t end)
{
    float nearest[EDGE_MATTE_TILE];
    float farthest[EDGE_MATTE_TILE] = {0};
    soft_depth_range range = {EDGE_MATTE_FAR, 0.0f};
    for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
        nearest[i] = EDGE_MATTE_FAR;
    }
    for (int32_t y = begin; y < end; y++) {
        const float *a = rlf_f32_row(near_z, y) + x0;
        const float *b = rlf_f32_row(far_z, y) + x0;
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
            float here = here_or_far(a[i]);
            float beyond = here_or_far(b[i]);
            nearest[i] = here < nearest[i] ? here : nearest[i];
            farthest[i] = beyond > farthest[i] ? beyond : farthest[i];
        }
    }
    for (int32_t i = 0; i < EDGE_MATTE_TILE; i++) {
        range.near_z = nearest[i] < range.near_z ? nearest[i] : range.near_z;
        range.far_z = farthest[i] > range.far_z ? farthest[i] : range.far_z;
    }
    return range;
}

/* Of a row of tiles; where no bodies are, any depth there is. */
RLF_KERNEL static void find_ranges(const soft *s, int32_t begin, int32_t end, soft_depth_range *out)
{
    const edge_matte *l = &s->edges;
    const int32_t first = begin / EDGE_MATTE_TILE * l->columns;
    for (int32_t k = 0; k < l->columns; k++) {
        const edge_matte_tile *own = &l->own[first + k];
        const int32_t x0 = k * EDGE_MATTE_TILE;
        if (own->far_z < own->near_z) {
            out[k] = (soft_depth_range){0.0f, EDGE_MATTE_FAR};
        } else if ((l->marks[first + k] & EDGE_MATTE_EDGE) != 0) {
            out[k] = range_of(&l->near_z, &l->far_z, x0, begin, end);
        } else {
            out[k] = (soft_depth_range){l->real[first + k].near_z, l->real[first + k].far_z};
        }
    }
}

static void draw_band(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const draw_job *job = context;
    const soft *s = job->s;
    if (job->with_background) {
        soft_draw_background(s, begin, end);
    }
    soft_draw_shadows(s, s->shade_tiles[worker], begin, end);
    bool is_layered = s->def.occlusion == RLF_OCCLUSION_THESIS;
    soft_group *group = &s->workers[worker];
    band_faces list = {group->list, 0};
    list_faces(s, begin, end, is_layered, &list);
    if (list.count > 0 && s->def.occlusion == RLF_OCCLUSION_SOFT) {
        find_ranges(s, begin, end, group->tiles);
    }
    for (int32_t y = begin; list.count > 0 && y < end; y += SOFT_GROUP_ROWS) {
        group->row_count = end - y < SOFT_GROUP_ROWS ? end - y : SOFT_GROUP_ROWS;
        for (int32_t i = 0; i < group->row_count; i++) {
            group->rows[i].y = y + i;
            group->rows[i].real = real_row(s, group->tiles, y + i);
        }
        int32_t count = find_ends(s, &list, group);
        soft_find_alone(&s->scene, count, group);
        if (is_layered) {
            draw_layers(s, count, group);
        } else {
            draw_together(s, count, group);
        }
    }
}

void soft_draw_bodies(soft *s, bool with_background)
{
    draw_job job = {s, with_background};
    rlf_parallel_for(s->def.pool, s->camera.height, SOFT_BAND_ROWS, draw_band, &job);
}
