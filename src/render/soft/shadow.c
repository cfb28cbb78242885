/* Soft shadows of the bodies on the real surfaces: see caster.h. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define TILE SILHOUETTE_TILE          /* pixels; a band of rows is as high */
#define SAMPLES (TILE / CASTER_BLOCK) /* of a tile's row */

/* One band of rows while the bodies take light from it. */
typedef struct shade_band {
    const soft *s;
    int32_t begin, end; /* rows */
    soft_shade_tile *tiles;
} shade_band;

/* Every CASTER_BLOCK-th pixel of the tile; without depth beyond the picture. */
static void gather(const shade_band *b, int32_t column, soft_shade_tile *tile)
{
    const rlf_camera *k = &b->s->camera;
    for (int32_t i = 0; i < SOFT_SHADE_SAMPLES; i++) {
        int32_t x = column * TILE + i % SAMPLES * CASTER_BLOCK;
        int32_t y = b->begin + i / SAMPLES * CASTER_BLOCK;
        bool is_inside = x < k->width && y < b->end;
        tile->x[i] = (float)((x - k->cx) / k->fx);
        tile->y[i] = (float)((y - k->cy) / k->fy);
        tile->z[i] = is_inside ? rlf_f32_row(&b->s->real.z, y)[x] : 0.0f;
        tile->light[i] = 1.0f;
    }
}

/* A ball about all of a tile's samples: about the middle ray, as deep as they are. */
static void bound(soft_shade_tile *tile)
{
    float near_z = 1e9f;
    float far_z = 0.0f;
    for (int32_t i = 0; i < SOFT_SHADE_SAMPLES; i++) {
        float z = tile->z[i];
        near_z = z > 0.0f && z < near_z ? z : near_z;
        far_z = z > far_z ? z : far_z;
    }
    const int32_t last = SOFT_SHADE_SAMPLES - 1;
    float x = 0.5f * (tile->x[0] + tile->x[last]);
    float y = 0.5f * (tile->y[0] + tile->y[last]);
    float half_x = 0.5f * (tile->x[last] - tile->x[0]);
    float half_y = 0.5f * (tile->y[last] - tile->y[0]);
    float middle = 0.5f * (near_z + far_z);
    tile->center[0] = middle * x;
    tile->center[1] = middle * y;
    tile->center[2] = middle;
    tile->radius = 0.5f * (far_z - near_z) * sqrtf(x * x + y * y + 1.0f) +
                   far_z * sqrtf(half_x * half_x + half_y * half_y);
    tile->has_depth = far_z > 0.0f;
}

static soft_shade_tile *tile_at(const shade_band *b, int32_t column)
{
    soft_shade_tile *tile = &b->tiles[column];
    if (!tile->is_known) {
        gather(b, column, tile);
        bound(tile);
        tile->is_known = true;
    }
    return tile;
}

static void shade_by(const shade_band *b, const caster *c, const caster_rect *r)
{
    const soft *s = b->s;
    const float to_light[3] = {(float)s->to_light.x, (float)s->to_light.y, (float)s->to_light.z};
    if (r->y0 >= b->end || r->y1 <= b->begin) {
        return;
    }
    for (int32_t column = r->x0 / TILE; column * TILE < r->x1; column++) {
        soft_shade_tile *tile = tile_at(b, column);
        const caster_points points = {tile->x, tile->y, tile->z, SOFT_SHADE_SAMPLES};
        int32_t takes = tile->has_depth ? caster_may_take(c, to_light, tile->center, tile->radius)
                                        : CASTER_TAKES_NOTHING;
        if ((takes & CASTER_TAKES_AMBIENT) != 0) {
            caster_take_ambient(c, &points, (float)CASTER_AMBIENT_SHARE, tile->light);
        }
        if ((takes & CASTER_TAKES_DIRECT) != 0) {
            caster_take_direct(c, &points, (float)CASTER_DIRECT_SHARE, tile->light);
        }
        tile->is_shaded = tile->is_shaded || takes != CASTER_TAKES_NOTHING;
    }
}

RLF_KERNEL static void darken(const float *restrict light, int32_t count, uint8_t *restrict bytes)
{
    for (int32_t i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(int32_t)((float)bytes[i] * light[i] + 0.5f);
    }
}

/* Each sample's light goes to the pixels of its block. */
static void darken_tile(const shade_band *b, int32_t column)
{
    const soft *s = b->s;
    int32_t x0 = column * TILE;
    int32_t count = x0 + TILE < s->camera.width ? TILE : s->camera.width - x0;
    float share[4 * TILE] = {0};
    for (int32_t y = b->begin; y < b->end; y++) {
        const float *light = b->tiles[column].light + (y - b->begin) / CASTER_BLOCK * SAMPLES;
        for (int32_t x = 0; (y - b->begin) % CASTER_BLOCK == 0 && x < TILE; x++) {
            float here = light[x / CASTER_BLOCK];
            share[4 * x] = here;
            share[4 * x + 1] = here;
            share[4 * x + 2] = here;
            share[4 * x + 3] = 1.0f;
        }
        darken(share, 4 * count, rlf_rgba8_row(&s->image, y) + 4 * (ptrdiff_t)x0);
    }
}

void soft_draw_shadows(const soft *s, soft_shade_tile *tiles, int32_t begin, int32_t end)
{
    if (s->scene.caster_count == 0) {
        return;
    }
    shade_band b = {s, begin, end, tiles};
    int32_t columns = (s->camera.width + TILE - 1) / TILE;
    for (int32_t column = 0; column < columns; column++) {
        tiles[column].is_known = false;
        tiles[column].is_shaded = false;
    }
    for (int32_t i = 0; i < s->scene.caster_count; i++) {
        if (s->scene.casters[i].near_m > 0.0f) {
            shade_by(&b, &s->scene.casters[i], &s->scene.reach[i]);
        }
    }
    for (int32_t column = 0; column < columns; column++) {
        if (tiles[column].is_shaded) {
            darken_tile(&b, column);
        }
    }
}
