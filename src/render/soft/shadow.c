/* Soft shadows of the bodies on the real surfaces: see caster.h. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define TILE SILHOUETTE_TILE /* pixels; a band of rows is as high */
#define SAMPLES (TILE / CASTER_BLOCK)

/* One band of rows while the bodies take light from it. */
typedef struct shade_band {
    const soft *s;
    int32_t begin, end; /* rows */
    soft_shade_work *work;
} shade_band;

RLF_KERNEL static void find_depths(const float *restrict z, int32_t count, float *restrict near_z,
                                   float *restrict far_z)
{
    float low = *near_z;
    float high = *far_z;
    for (int32_t i = 0; i < count; i++) {
        float here = z[i] > 0.0f ? z[i] : 1e9f;
        low = here < low ? here : low;
        high = z[i] > high ? z[i] : high;
    }
    *near_z = low;
    *far_z = high;
}

/* A ball about all that is real in the tile: its middle and radius, found when first needed. */
static const soft_shade_tile *tile_at(const shade_band *b, int32_t column)
{
    soft_shade_tile *tile = &b->work->tiles[column];
    if (tile->is_known) {
        return tile;
    }
    const rlf_camera *k = &b->s->camera;
    int32_t x0 = column * TILE;
    int32_t x1 = x0 + TILE < k->width ? x0 + TILE : k->width;
    float near_z = 1e9f;
    float far_z = 0.0f;
    for (int32_t y = b->begin; y < b->end; y += CASTER_BLOCK) {
        find_depths(rlf_f32_row(&b->s->real.z, y) + x0, x1 - x0, &near_z, &far_z);
    }
    double x = (0.5 * (x0 + x1 - 1) - k->cx) / k->fx;
    double y = (0.5 * (b->begin + b->end - 1) - k->cy) / k->fy;
    double middle = 0.5 * ((double)near_z + (double)far_z);
    double half_x = 0.5 * TILE / k->fx;
    double half_y = 0.5 * TILE / k->fy;
    double along = 0.5 * ((double)far_z - (double)near_z) * sqrt(x * x + y * y + 1.0);
    double across = (double)far_z * sqrt(half_x * half_x + half_y * half_y);
    *tile = (soft_shade_tile){{(float)(middle * x), (float)(middle * y), (float)middle},
                              (float)(along + across),
                              far_z > 0.0f,
                              true,
                              false};
    return tile;
}

/* Samples of a row of the tile, every CASTER_BLOCK-th pixel. */
static void gather(const float *row, int32_t x0, int32_t width, float z[SAMPLES])
{
    int32_t count = 0;
    for (int32_t x = x0; x < x0 + TILE && x < width; x += CASTER_BLOCK) {
        z[count++] = row[x];
    }
}

static void take_light(const caster *c, const shade_band *b, int32_t column, int32_t takes)
{
    const rlf_camera *k = &b->s->camera;
    soft_shade_tile *tile = &b->work->tiles[column];
    int32_t x0 = column * TILE;
    for (int32_t y = b->begin; y < b->end; y += CASTER_BLOCK) {
        float z[SAMPLES] = {0};
        int32_t line = (y - b->begin) / CASTER_BLOCK;
        float *light = b->work->light + line * b->work->stride + column * SAMPLES;
        caster_rays rays = {(float)((x0 - k->cx) / k->fx), (float)(CASTER_BLOCK / k->fx),
                            (float)((y - k->cy) / k->fy)};
        gather(rlf_f32_row(&b->s->real.z, y), x0, k->width, z);
        for (int32_t i = 0; !tile->is_shaded && i < SAMPLES; i++) {
            light[i] = 1.0f;
        }
        if ((takes & CASTER_TAKES_AMBIENT) != 0) {
            caster_take_ambient(c, &rays, z, SAMPLES, (float)CASTER_AMBIENT_SHARE, light);
        }
        if ((takes & CASTER_TAKES_DIRECT) != 0) {
            caster_take_direct(c, &rays, z, SAMPLES, (float)CASTER_DIRECT_SHARE, light);
        }
    }
    tile->is_shaded = true;
}

static void shade_by(const shade_band *b, const caster *c, const caster_rect *r)
{
    const soft *s = b->s;
    const float to_light[3] = {(float)s->to_light.x, (float)s->to_light.y, (float)s->to_light.z};
    if (r->y0 >= b->end || r->y1 <= b->begin) {
        return;
    }
    for (int32_t column = r->x0 / TILE; column * TILE < r->x1; column++) {
        const soft_shade_tile *tile = tile_at(b, column);
        int32_t takes = tile->has_depth ? caster_may_take(c, to_light, tile->center, tile->radius)
                                        : CASTER_TAKES_NOTHING;
        if (takes != CASTER_TAKES_NOTHING) {
            take_light(c, b, column, takes);
        }
    }
}

RLF_KERNEL static void darken(const float *restrict light, int32_t count, uint8_t *restrict bytes)
{
    for (int32_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(int32_t)((float)bytes[i] * light[i] + 0.5f);
    }
}

/* Each sample's light goes to the pixels of its block. */
static void darken_tile(const soft *s, const soft_shade_work *work, int32_t column, int32_t begin,
                        int32_t end)
{
    int32_t x0 = column * TILE;
    int32_t count = x0 + TILE < s->camera.width ? TILE : s->camera.width - x0;
    float share[4 * TILE];
    for (int32_t y = begin; y < end; y++) {
        int32_t line = (y - begin) / CASTER_BLOCK;
        const float *light = work->light + line * work->stride + column * SAMPLES;
        for (int32_t x = 0; (y - begin) % CASTER_BLOCK == 0 && x < TILE; x++) {
            float here = light[x / CASTER_BLOCK];
            share[4 * x] = here;
            share[4 * x + 1] = here;
            share[4 * x + 2] = here;
            share[4 * x + 3] = 1.0f;
        }
        darken(share, 4 * count, rlf_rgba8_row(&s->image, y) + 4 * (ptrdiff_t)x0);
    }
}

void soft_draw_shadows(const soft *s, soft_shade_work *work, int32_t begin, int32_t end)
{
    if (s->scene.caster_count == 0) {
        return;
    }
    shade_band b = {s, begin, end, work};
    int32_t columns = (s->camera.width + TILE - 1) / TILE;
    for (int32_t column = 0; column < columns; column++) {
        work->tiles[column].is_known = false;
        work->tiles[column].is_shaded = false;
    }
    for (int32_t i = 0; i < s->scene.caster_count; i++) {
        if (s->scene.casters[i].near_m > 0.0f) {
            shade_by(&b, &s->scene.casters[i], &s->scene.reach[i]);
        }
    }
    for (int32_t column = 0; column < columns; column++) {
        if (work->tiles[column].is_shaded) {
            darken_tile(s, work, column, begin, end);
        }
    }
}
