/* Draws the bodies into the picture, row by row: samples first, then colour, then what hides them.
 *
 * RLF_OCCLUSION_DEPTH, SOFT and OFF draw all bodies into one set of samples. RLF_OCCLUSION_THESIS
 * (4.2.2) goes body by body from the far to the near: the body is drawn alone, and where it is (the
 * stencil) the real picture is blended over it where the real depth is less than the body's z, per
 * pixel (errata 8). */
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

/* Pixels of a row that some face touches. */
typedef struct touched {
    int32_t x0, x1;
} touched;

/* Draws faces [first, end) of the list into the row's samples and sums. */
static touched draw_faces(const soft *s, const band_faces *list, int32_t first, int32_t end,
                          const soft_row *row, const soft_real_row *real)
{
    touched t = {row->width, 0};
    int32_t count = 0;
    for (int32_t i = first; i < end; i++) {
        int32_t id = list->faces[i];
        const soft_face *face = &s->scene.faces[id];
        soft_span *span = &row->spans[count];
        if (row->y >= face->y_begin && row->y < face->y_end &&
            soft_raster_row(face, id, row, span)) {
            t.x0 = span->x0 < t.x0 ? span->x0 : t.x0;
            t.x1 = span->x1 > t.x1 ? span->x1 : t.x1;
            count++;
        }
    }
    for (int32_t i = 0; i < count; i++) {
        const soft_face *face = &s->scene.faces[row->spans[i].face];
        soft_shade_span(s, face, row, real, &row->spans[i]);
    }
    return t;
}

static void clear_row(const soft_row *row, touched t)
{
    size_t count = (size_t)(t.x1 - t.x0);
    for (int k = 0; k < SOFT_SAMPLES; k++) {
        memset(row->inverse_z + k * row->stride + t.x0, 0, count * sizeof(float));
        memset(row->face + k * row->stride + t.x0, 0, count * sizeof(int32_t));
    }
    for (int k = 0; k < SOFT_SUMS; k++) {
        memset(row->sum[k] + t.x0, 0, count * sizeof(float));
    }
}

static void draw_together(const soft *s, const band_faces *list, const soft_row *row,
                          const soft_real_row *real)
{
    touched t = draw_faces(s, list, 0, list->count, row, real);
    if (t.x0 < t.x1) {
        float *const sum[4] = {row->sum[0] + t.x0, row->sum[1] + t.x0, row->sum[2] + t.x0,
                               row->sum[3] + t.x0};
        soft_compose_row(sum, t.x1 - t.x0, rlf_rgba8_row(&s->image, row->y) + 4 * (ptrdiff_t)t.x0,
                         rlf_u8_row(&s->matte, row->y) + t.x0);
        clear_row(row, t);
    }
}

/* One body over the layers behind it: inside its silhouette they are gone, behind the body or
 * behind the real picture that is drawn over it. */
static void add_layer(const soft_row *row, touched t)
{
    for (int k = 0; k < 4; k++) {
        float *layer = row->layer[k];
        for (int32_t x = t.x0; x < t.x1; x++) {
            layer[x] = layer[x] * (1.0f - row->sum[4][x]) + row->sum[k][x];
        }
    }
}

static void draw_layers(const soft *s, const band_faces *list, const soft_row *row,
                        const soft_real_row *real)
{
    touched all = {row->width, 0};
    for (int32_t first = 0; first < list->count;) {
        int32_t body = s->scene.faces[list->faces[first]].body;
        int32_t end = first;
        while (end < list->count && s->scene.faces[list->faces[end]].body == body) {
            end++;
        }
        touched t = draw_faces(s, list, first, end, row, real);
        if (t.x0 < t.x1) {
            add_layer(row, t);
            clear_row(row, t);
            all.x0 = t.x0 < all.x0 ? t.x0 : all.x0;
            all.x1 = t.x1 > all.x1 ? t.x1 : all.x1;
        }
        first = end;
    }
    if (all.x0 < all.x1) {
        float *const layer[4] = {row->layer[0] + all.x0, row->layer[1] + all.x0,
                                 row->layer[2] + all.x0, row->layer[3] + all.x0};
        soft_compose_row(layer, all.x1 - all.x0,
                         rlf_rgba8_row(&s->image, row->y) + 4 * (ptrdiff_t)all.x0,
                         rlf_u8_row(&s->matte, row->y) + all.x0);
        for (int k = 0; k < 4; k++) {
            memset(layer[k], 0, (size_t)(all.x1 - all.x0) * sizeof(float));
        }
    }
}

/* What may hide a body in row y. */
static soft_real_row real_row(const soft *s, int32_t y)
{
    soft_real_row real = {.width = s->camera.width};
    if (s->def.occlusion == RLF_OCCLUSION_SOFT) {
        real.near_z = rlf_f32_row(&s->silhouette.near_z, y);
        real.far_z = rlf_f32_row(&s->silhouette.far_z, y);
        real.cover = rlf_u8_row(&s->silhouette.cover, y);
        real.noise = rlf_kernel_noise_make(&s->def.rig.noise);
    } else if (s->def.occlusion != RLF_OCCLUSION_OFF) {
        int32_t last = s->camera.height - 1;
        real.row = rlf_f32_row(&s->real.z, y);
        real.above = rlf_f32_row(&s->real.z, y > 0 ? y - 1 : y);
        real.below = rlf_f32_row(&s->real.z, y < last ? y + 1 : y);
    }
    return real;
}

static void draw_band(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const soft *s = context;
    soft_draw_shadows(s, s->shade_tiles[worker], begin, end);
    bool is_layered = s->def.occlusion == RLF_OCCLUSION_THESIS;
    soft_row row = s->workers[worker];
    band_faces list = {row.list, 0};
    list_faces(s, begin, end, is_layered, &list);
    for (row.y = begin; list.count > 0 && row.y < end; row.y++) {
        soft_real_row real = real_row(s, row.y);
        if (is_layered) {
            draw_layers(s, &list, &row, &real);
        } else {
            draw_together(s, &list, &row, &real);
        }
    }
}

void soft_draw_bodies(soft *s)
{
    rlf_parallel_for(s->def.pool, s->camera.height, SOFT_BAND_ROWS, draw_band, s);
}
