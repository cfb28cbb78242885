/* Draws the bodies into the picture, band by band: samples first, then colour, then what hides
 * them.
 *
 * RLF_OCCLUSION_DEPTH draws all bodies into one set of samples and compares each pixel with the
 * real depth. RLF_OCCLUSION_THESIS (4.2.2) goes body by body from the far to the near: the body is
 * drawn alone, and where it is (the stencil) the real picture is blended over it where the real
 * depth is less than the body's z, per pixel (errata 8). */
#include "render/soft/soft.h"

#include <string.h>

/* A part of a band: rows y0..y1 and columns x0..x1 of the picture. */
typedef struct band_area {
    int32_t band_y0; /* picture row of the band's first row */
    int32_t x0, y0, x1, y1;
} band_area;

static soft_row row_of(const soft *s, const soft_band *band, const band_area *area, int32_t y)
{
    ptrdiff_t first = (ptrdiff_t)(y - area->band_y0) * SOFT_SAMPLES * s->camera.width;
    soft_row row = {band->inverse_z + first, band->triangle + first, y, s->camera.width};
    return row;
}

static void clear_samples(const soft *s, const soft_band *band, const band_area *area)
{
    size_t count = (size_t)(area->x1 - area->x0);
    for (int32_t y = area->y0; y < area->y1; y++) {
        soft_row row = row_of(s, band, area, y);
        for (int k = 0; k < SOFT_SAMPLES; k++) {
            ptrdiff_t first = (ptrdiff_t)k * row.width + area->x0;
            memset(row.inverse_z + first, 0, count * sizeof(float));
            memset(row.triangle + first, 0, count * sizeof(int32_t));
        }
    }
}

static void raster_body(const soft *s, const soft_band *band, const band_area *area,
                        const soft_body *body)
{
    for (int32_t id = body->first; id < body->end; id++) {
        const soft_triangle *t = &s->scene.triangles[id];
        int32_t begin = t->y_begin > area->y0 ? t->y_begin : area->y0;
        int32_t end = t->y_end < area->y1 ? t->y_end : area->y1;
        for (int32_t y = begin; y < end; y++) {
            soft_row row = row_of(s, band, area, y);
            soft_raster_row(t, id, &row);
        }
    }
}

/* ---- what hides a body ---------------------------------------------------------------------- */

/* Real depth around a pixel: itself twice and its four neighbours, so that edges are not jagged. */
typedef struct real_taps {
    float z[5];
} real_taps;

static real_taps taps_at(const soft *s, int32_t x, int32_t y)
{
    int32_t left = x > 0 ? x - 1 : x;
    int32_t right = x < s->camera.width - 1 ? x + 1 : x;
    int32_t above = y > 0 ? y - 1 : y;
    int32_t below = y < s->camera.height - 1 ? y + 1 : y;
    const float *row = rlf_f32_row(&s->real.z, y);
    real_taps taps = {{row[x], row[left], row[right], rlf_f32_row(&s->real.z, above)[x],
                       rlf_f32_row(&s->real.z, below)[x]}};
    return taps;
}

/* Share of a surface at z that shows before the real world: 0..1 in sixths. */
static float share_in_front(const real_taps *taps, float z)
{
    int32_t shown = 0;
    for (int i = 0; i < 5; i++) {
        bool is_hidden = taps->z[i] > 0.0f && taps->z[i] < z;
        shown += is_hidden ? 0 : (i == 0 ? 2 : 1);
    }
    return (float)shown * (1.0f / 6.0f);
}

/* ---- colour of a pixel ---------------------------------------------------------------------- */

/* Sum over the samples of a pixel. */
typedef struct pixel_sum {
    float color[3]; /* times shown */
    float covered;  /* share of samples that see a body */
    float shown;    /* the same after occlusion */
} pixel_sum;

static float clamp01(float x)
{
    return x < 0.0f ? 0.0f : (x > 1.0f ? 1.0f : x);
}

static float share_soft(const soft *s, const float at[2], float z)
{
    ptrdiff_t i = (ptrdiff_t)at[1] * s->camera.width + (ptrdiff_t)at[0];
    float fade = 0.25f / (float)rlf_depth_noise_sigma(&s->def.rig.noise, (double)z);
    float near_share = clamp01(0.5f + (s->silhouette.near_z.data[i] - z) * fade);
    float far_share = clamp01(0.5f + (s->silhouette.far_z.data[i] - z) * fade);
    float cover = (float)s->silhouette.cover.data[i] * (1.0f / 255.0f);
    return far_share + (near_share - far_share) * cover;
}

static void add_samples(const soft *s, const real_taps *taps, int32_t id, pixel_sum *sum,
                        const float at[3])
{
    soft_fragment f = soft_shade(&s->scene, &s->scene.triangles[id], at[0], at[1]);
    float coverage = at[2];
    float shown = taps != NULL ? coverage * share_in_front(taps, f.z) : coverage;
    if (s->def.occlusion == RLF_OCCLUSION_SOFT) {
        shown = coverage * share_soft(s, at, f.z);
    }
    sum->covered += coverage;
    sum->shown += shown;
    for (int c = 0; c < 3; c++) {
        sum->color[c] += f.color[c] * shown;
    }
}

/* Shades each triangle that the pixel's samples see, once. */
static pixel_sum sum_pixel(const soft *s, const int32_t id[SOFT_SAMPLES], int32_t x, int32_t y)
{
    pixel_sum sum = {{0, 0, 0}, 0, 0};
    real_taps taps_here;
    const real_taps *taps = NULL;
    if (s->def.occlusion != RLF_OCCLUSION_OFF) {
        taps_here = taps_at(s, x, y);
        taps = &taps_here;
    }
    if (id[0] == id[1] && id[0] == id[2] && id[0] == id[3]) {
        const float at[3] = {(float)x, (float)y, 1.0f};
        add_samples(s, taps, id[0], &sum, at);
        return sum;
    }
    for (int k = 0; k < SOFT_SAMPLES; k++) {
        int32_t count = 0;
        bool is_first = id[k] != 0;
        for (int j = 0; j < SOFT_SAMPLES; j++) {
            count += id[j] == id[k] ? 1 : 0;
            is_first = is_first && (j >= k || id[j] != id[k]);
        }
        if (is_first) {
            const float at[3] = {(float)x, (float)y, (float)count * (1.0f / SOFT_SAMPLES)};
            add_samples(s, taps, id[k], &sum, at);
        }
    }
    return sum;
}

/* Picture = real picture * (1 - alpha) + colour, colour being premultiplied. */
static void compose_pixel(const soft *s, int32_t x, int32_t y, const float layer[4])
{
    uint8_t *pixel = rlf_rgba8_row(&s->image, y) + 4 * (ptrdiff_t)x;
    float rest = 1.0f - layer[3];
    for (int c = 0; c < 3; c++) {
        float value = (float)pixel[c] * rest + layer[c] + 0.5f;
        pixel[c] = (uint8_t)(value < 255.0f ? value : 255.0f);
    }
    float alpha = 255.0f * layer[3] + 0.5f;
    rlf_u8_row(&s->matte, y)[x] = (uint8_t)(alpha < 255.0f ? alpha : 255.0f);
}

/* Calls nothing for pixels without a body: most of the picture. */
static bool read_samples(const soft_row *row, int32_t x, int32_t id[SOFT_SAMPLES])
{
    int32_t any = 0;
    for (int k = 0; k < SOFT_SAMPLES; k++) {
        id[k] = row->triangle[(ptrdiff_t)k * row->width + x];
        any |= id[k];
    }
    return any != 0;
}

/* ---- bands ---------------------------------------------------------------------------------- */

/* The part of a body's rectangle in rows [begin, end); false when it has none. */
static bool cut_body(const soft_body *body, int32_t begin, int32_t end, band_area *out)
{
    out->band_y0 = begin;
    out->x0 = body->x0;
    out->x1 = body->x1;
    out->y0 = body->y0 > begin ? body->y0 : begin;
    out->y1 = body->y1 < end ? body->y1 : end;
    return out->y0 < out->y1 && out->x0 < out->x1;
}

static void draw_together(const soft *s, const soft_band *band, const band_area *all)
{
    clear_samples(s, band, all);
    for (int32_t i = 0; i < s->scene.body_count; i++) {
        band_area area;
        if (cut_body(&s->scene.bodies[i], all->y0, all->y1, &area)) {
            raster_body(s, band, &area, &s->scene.bodies[i]);
        }
    }
    for (int32_t y = all->y0; y < all->y1; y++) {
        soft_row row = row_of(s, band, all, y);
        for (int32_t x = all->x0; x < all->x1; x++) {
            int32_t id[SOFT_SAMPLES];
            if (read_samples(&row, x, id)) {
                pixel_sum sum = sum_pixel(s, id, x, y);
                const float layer[4] = {sum.color[0], sum.color[1], sum.color[2], sum.shown};
                compose_pixel(s, x, y, layer);
            }
        }
    }
}

static float *layer_at(const soft *s, const soft_band *band, const band_area *area, int32_t y)
{
    return band->layer + 4 * (ptrdiff_t)(y - area->band_y0) * s->camera.width;
}

/* One body over the layers behind it: inside its silhouette they are gone, behind the body or
 * behind the real picture that is drawn over it. */
static void draw_layer(const soft *s, const soft_band *band, const band_area *area,
                       const soft_body *body)
{
    clear_samples(s, band, area);
    raster_body(s, band, area, body);
    for (int32_t y = area->y0; y < area->y1; y++) {
        soft_row row = row_of(s, band, area, y);
        float *layer = layer_at(s, band, area, y);
        for (int32_t x = area->x0; x < area->x1; x++) {
            int32_t id[SOFT_SAMPLES];
            if (!read_samples(&row, x, id)) {
                continue;
            }
            pixel_sum sum = sum_pixel(s, id, x, y);
            float *under = layer + 4 * (ptrdiff_t)x;
            for (int c = 0; c < 3; c++) {
                under[c] = under[c] * (1.0f - sum.covered) + sum.color[c];
            }
            under[3] = under[3] * (1.0f - sum.covered) + sum.shown;
        }
    }
}

static void draw_layers(const soft *s, const soft_band *band, const band_area *all)
{
    for (int32_t y = all->y0; y < all->y1; y++) {
        memset(layer_at(s, band, all, y) + 4 * (ptrdiff_t)all->x0, 0,
               4 * (size_t)(all->x1 - all->x0) * sizeof(float));
    }
    for (int32_t i = s->scene.body_count - 1; i >= 0; i--) {
        band_area area;
        if (cut_body(&s->scene.bodies[i], all->y0, all->y1, &area)) {
            draw_layer(s, band, &area, &s->scene.bodies[i]);
        }
    }
    for (int32_t y = all->y0; y < all->y1; y++) {
        const float *layer = layer_at(s, band, all, y);
        for (int32_t x = all->x0; x < all->x1; x++) {
            if (layer[4 * (ptrdiff_t)x + 3] > 0.0f) {
                compose_pixel(s, x, y, layer + 4 * (ptrdiff_t)x);
            }
        }
    }
}

static void draw_band(void *context, int32_t begin, int32_t end, int32_t worker)
{
    const soft *s = context;
    soft_draw_shadows(s, begin, end);
    band_area all = {begin, s->camera.width, begin, 0, end};
    for (int32_t i = 0; i < s->scene.body_count; i++) {
        band_area area;
        if (cut_body(&s->scene.bodies[i], begin, end, &area)) {
            all.x0 = area.x0 < all.x0 ? area.x0 : all.x0;
            all.x1 = area.x1 > all.x1 ? area.x1 : all.x1;
        }
    }
    if (all.x0 >= all.x1) {
        return;
    }
    if (s->def.occlusion == RLF_OCCLUSION_THESIS) {
        draw_layers(s, &s->bands[worker], &all);
    } else {
        draw_together(s, &s->bands[worker], &all);
    }
}

void soft_draw_bodies(soft *s)
{
    rlf_parallel_for(s->def.pool, s->camera.height, SOFT_BAND_ROWS, draw_band, s);
}
