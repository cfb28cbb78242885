/* Soft shadows of the bodies on the real surfaces: see caster.h.
 *
 * Where the real depth is smooth the light is worked out every few pixels and is linear between;
 * around edges every CASTER_BLOCK pixels have their own. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define WIDTH SOFT_SHADE_WIDTH
#define HARDLY 0.998f /* light that is left: less than half a step of 8 bits is lost */

/* One band of rows while the bodies take light from it. */
typedef struct shade_band {
    const soft *s;
    int32_t begin, end; /* rows */
    soft_shade_tile *tiles;
} shade_band;

static int32_t at_most(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* Samples of the tile `step` pixels apart, the last ones `beyond` its last pixels; at the picture's
 * edge they repeat. */
static void gather(const shade_band *b, int32_t column, int32_t step, int32_t beyond,
                   soft_shade_tile *tile)
{
    const soft *s = b->s;
    tile->step = step;
    tile->columns = WIDTH / step + beyond;
    tile->count = tile->columns * (SOFT_BAND_ROWS / step + beyond);
    for (int32_t i = 0; i < tile->count; i++) {
        int32_t x = at_most(column * WIDTH + i % tile->columns * step, s->camera.width - 1);
        int32_t y = at_most(b->begin + i / tile->columns * step, s->camera.height - 1);
        tile->x[i] = s->ray_x0 + s->ray_step_x * (float)x;
        tile->y[i] = s->ray_y0 + s->ray_step_y * (float)y;
        tile->z[i] = rlf_f32_row(&s->real.z, y)[x];
        tile->light[i] = 1.0f;
    }
}

/* False when depth jumps, or begins, between samples. */
static bool is_smooth(const soft_shade_tile *tile)
{
    for (int32_t i = 0; i < tile->count; i++) {
        int32_t right = (i + 1) % tile->columns != 0 ? i + 1 : i;
        int32_t below = i + tile->columns < tile->count ? i + tile->columns : i;
        if (silhouette_jumps(tile->z[i], tile->z[right]) ||
            silhouette_jumps(tile->z[i], tile->z[below])) {
            return false;
        }
    }
    return true;
}

/* A ball about all of a tile's samples: about the middle ray, as deep as they are. */
static void bound(soft_shade_tile *tile)
{
    float near_z = 1e9f;
    float far_z = 0.0f;
    for (int32_t i = 0; i < tile->count; i++) {
        float z = tile->z[i];
        near_z = z > 0.0f && z < near_z ? z : near_z;
        far_z = z > far_z ? z : far_z;
    }
    const int32_t last = tile->count - 1;
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
        gather(b, column, b->s->shade_px, 1, tile);
        if (!is_smooth(tile)) {
            gather(b, column, CASTER_BLOCK, 0, tile);
        }
        bound(tile);
        tile->is_known = true;
    }
    return tile;
}

static void shade_by(const shade_band *b, const caster *c, const caster_rect *r)
{
    const soft *s = b->s;
    if (r->y0 >= b->end || r->y1 <= b->begin) {
        return;
    }
    for (int32_t column = r->x0 / WIDTH; column * WIDTH < r->x1; column++) {
        soft_shade_tile *tile = tile_at(b, column);
        const caster_points points = {tile->x, tile->y, tile->z, tile->count};
        int32_t takes = tile->has_depth ? caster_may_take(c, s->light, tile->center, tile->radius)
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

static void put_light(float *share, float light)
{
    share[0] = light;
    share[1] = light;
    share[2] = light;
}

/* Light of a row of a tile, `row` pixels from its top, for each byte of its pixels. */
static void spread_light(const soft_shade_tile *tile, int32_t row, float share[4 * WIDTH])
{
    const int32_t step = tile->step;
    const float *light = tile->light + row / step * tile->columns;
    if (step == CASTER_BLOCK) {
        for (int32_t x = 0; x < WIDTH; x++) {
            put_light(share + 4 * x, light[x / CASTER_BLOCK]);
        }
        return;
    }
    const float down = (float)(row % step) / (float)step;
    const float per_step = 1.0f / (float)step;
    float left = light[0] + (light[tile->columns] - light[0]) * down;
    for (int32_t k = 0; k + 1 < tile->columns; k++) {
        const float *cell = light + k + 1;
        float right = cell[0] + (cell[tile->columns] - cell[0]) * down;
        for (int32_t x = 0; x < step; x++) {
            put_light(share + 4 * (k * step + x), left + (right - left) * per_step * (float)x);
        }
        left = right;
    }
}

static void darken_tile(const shade_band *b, int32_t column)
{
    const soft *s = b->s;
    const soft_shade_tile *tile = &b->tiles[column];
    float least = 1.0f;
    for (int32_t i = 0; i < tile->count; i++) {
        least = tile->light[i] < least ? tile->light[i] : least;
    }
    if (least > HARDLY) {
        return;
    }
    int32_t x0 = column * WIDTH;
    int32_t count = at_most(WIDTH, s->camera.width - x0);
    float share[4 * WIDTH];
    for (int32_t x = 0; x < WIDTH; x++) {
        share[4 * x + 3] = 1.0f;
    }
    for (int32_t y = b->begin; y < b->end; y++) {
        spread_light(tile, y - b->begin, share);
        darken(share, 4 * count, rlf_rgba8_row(&s->image, y) + 4 * (ptrdiff_t)x0);
    }
}

void soft_draw_shadows(const soft *s, soft_shade_tile *tiles, int32_t begin, int32_t end)
{
    if (s->scene.caster_count == 0) {
        return;
    }
    shade_band b = {s, begin, end, tiles};
    int32_t columns = (s->camera.width + WIDTH - 1) / WIDTH;
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
