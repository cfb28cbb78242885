/* Soft shadows of the bodies on the real surfaces: see caster.h.
 *
 * Where the real depth is smooth the light is worked out every few pixels and is linear between;
 * around edges every pixel has its own, and that of both sides is mixed as the matte says. */
#include "render/soft/passes.h"

#include "environment/depth_edge.h"
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define WIDTH SOFT_SHADE_WIDTH
#define HARDLY 0.998f /* light that is left: less than half a step of 8 bits is lost */

#define COLUMNS_MOST ((RLF_IMAGE_SIZE_MAX + WIDTH - 1) / WIDTH + CASTER_LANES) /* of tiles */

/* One band of rows while the bodies take light from it. */
typedef struct shade_band {
    const soft *s;
    int32_t begin, end; /* rows */
    soft_shade_tile *tiles;
    /* balls about all of each tile that is known, picture camera frame; else anything */
    float x[COLUMNS_MOST], y[COLUMNS_MOST], z[COLUMNS_MOST], radius[COLUMNS_MOST];
} shade_band;

static int32_t at_most(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* True when the matte of an edge reaches into a tile. */
static bool has_edge(const shade_band *b, int32_t column)
{
    const edge_matte *l = &b->s->edges;
    const int32_t first = column * (WIDTH / EDGE_MATTE_TILE);
    bool any = false;
    for (int32_t k = first; b->s->def.occlusion == RLF_OCCLUSION_SOFT &&
                            k < at_most(first + WIDTH / EDGE_MATTE_TILE, l->columns);
         k++) {
        any = any || (l->marks[b->begin / EDGE_MATTE_TILE * l->columns + k] & EDGE_MATTE_EDGE) != 0;
    }
    return any;
}

/* Depths of the farther and the nearer surface of samples of a tile with an edge. */
static void gather_sides(const shade_band *b, int32_t column, soft_shade_tile *tile)
{
    const edge_matte *l = &b->s->edges;
    const uint8_t *marks = l->marks + b->begin / EDGE_MATTE_TILE * l->columns;
    for (int32_t i = 0; i < tile->count; i++) {
        const int32_t x = at_most(column * WIDTH + i % WIDTH, b->s->camera.width - 1);
        const int32_t y = at_most(b->begin + i / WIDTH, b->s->camera.height - 1);
        tile->near_z[i] = tile->z[i];
        tile->near_light[i] = 1.0f;
        if ((marks[x / EDGE_MATTE_TILE] & EDGE_MATTE_FILLED) != 0) {
            const float near_z = rlf_f32_row(&l->near_z, y)[x];
            const float far_z = rlf_f32_row(&l->far_z, y)[x];
            tile->near_z[i] = near_z < EDGE_MATTE_FAR ? near_z : 0.0f;
            tile->z[i] = far_z < EDGE_MATTE_FAR ? far_z : 0.0f;
        }
    }
}

/* Samples of the tile `step` pixels apart, the last ones `beyond` its last pixels; at the picture's
 * edge they repeat. Whole lanes: those beyond have no depth. */
static void gather(const shade_band *b, int32_t column, int32_t step, int32_t beyond,
                   soft_shade_tile *tile)
{
    const soft *s = b->s;
    int32_t at[WIDTH];
    float ray_x[WIDTH];
    const int32_t columns = WIDTH / step + beyond;
    const int32_t rows = SOFT_BAND_ROWS / step + beyond;
    for (int32_t k = 0; k < columns; k++) {
        at[k] = at_most(column * WIDTH + k * step, s->camera.width - 1);
        ray_x[k] = s->ray_x0 + s->ray_step_x * (float)at[k];
    }
    int32_t i = 0;
    for (int32_t row = 0; row < rows; row++) {
        const int32_t y = at_most(b->begin + row * step, s->camera.height - 1);
        const float *z = rlf_f32_row(&s->real.z, y);
        const float ray_y = s->ray_y0 + s->ray_step_y * (float)y;
        for (int32_t k = 0; k < columns; k++, i++) {
            tile->x[i] = ray_x[k];
            tile->y[i] = ray_y;
            tile->z[i] = z[at[k]];
        }
    }
    for (; i < SOFT_SHADE_SAMPLES && i % SOFT_LANES != 0; i++) {
        tile->x[i] = tile->y[i] = tile->z[i] = 0.0f;
    }
    tile->step = step;
    tile->columns = columns;
    tile->rows = rows;
    tile->count = i;
    for (i = 0; i < tile->count; i++) {
        tile->light[i] = 1.0f;
    }
}

RLF_KERNEL_PART int32_t count_jumps(const float *restrict a, const float *restrict b, int32_t count)
{
    int32_t sum = 0;
    for (int32_t i = 0; i < count; i++) {
        sum += depth_steps(a[i], b[i]) ? 1 : 0;
    }
    return sum;
}

/* False when depth jumps, or begins, between samples. */
RLF_KERNEL static bool is_smooth(const float *z, int32_t columns, int32_t rows)
{
    int32_t sum = count_jumps(z, z + columns, columns * (rows - 1));
    for (int32_t row = 0; row < rows; row++) {
        sum += count_jumps(z + row * columns, z + row * columns + 1, columns - 1);
    }
    return sum == 0;
}

/* Least depth there is, and greatest: 0 when there is none. */
RLF_KERNEL static void depth_range(const float *restrict z, int32_t count, float out[2])
{
    float near_z[SOFT_LANES];
    float far_z[SOFT_LANES] = {0};
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        near_z[i] = 1e9f;
    }
    for (int32_t first = 0; first < count; first += SOFT_LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < SOFT_LANES; i++) {
            const float here = z[first + i];
            const float seen = here > 0.0f ? here : 1e9f;
            near_z[i] = seen < near_z[i] ? seen : near_z[i];
            far_z[i] = here > far_z[i] ? here : far_z[i];
        }
    }
    out[0] = near_z[0];
    out[1] = far_z[0];
    for (int32_t i = 1; i < SOFT_LANES; i++) {
        out[0] = near_z[i] < out[0] ? near_z[i] : out[0];
        out[1] = far_z[i] > out[1] ? far_z[i] : out[1];
    }
}

/* A ball about all of a tile's samples: about the middle ray, as deep as they are. */
static void bound(shade_band *b, int32_t column)
{
    soft_shade_tile *tile = &b->tiles[column];
    float range[2];
    depth_range(tile->z, tile->count, range);
    if (tile->has_edge) {
        float nearer[2];
        depth_range(tile->near_z, tile->count, nearer);
        range[0] = nearer[0] < range[0] ? nearer[0] : range[0];
        range[1] = nearer[1] > range[1] ? nearer[1] : range[1];
    }
    const float near_z = range[0];
    const float far_z = range[1];
    const int32_t last = tile->columns * tile->rows - 1;
    float x = 0.5f * (tile->x[0] + tile->x[last]);
    float y = 0.5f * (tile->y[0] + tile->y[last]);
    float half_x = 0.5f * (tile->x[last] - tile->x[0]);
    float half_y = 0.5f * (tile->y[last] - tile->y[0]);
    float middle = 0.5f * (near_z + far_z);
    b->x[column] = middle * x;
    b->y[column] = middle * y;
    b->z[column] = middle;
    b->radius[column] = 0.5f * (far_z - near_z) * sqrtf(x * x + y * y + 1.0f) +
                        far_z * sqrtf(half_x * half_x + half_y * half_y);
    tile->has_depth = far_z > 0.0f;
}

static void know_tile(shade_band *b, int32_t column)
{
    soft_shade_tile *tile = &b->tiles[column];
    gather(b, column, b->s->shade_px, 1, tile);
    tile->has_edge = has_edge(b, column);
    if (tile->has_edge || !is_smooth(tile->z, tile->columns, tile->rows)) {
        gather(b, column, 1, 0, tile);
    }
    if (tile->has_edge) {
        gather_sides(b, column, tile);
    }
    bound(b, column);
    tile->is_known = true;
}

static void shade_points(const caster *c, int32_t takes, const caster_points *points, float *light)
{
    if ((takes & CASTER_TAKES_AMBIENT) != 0) {
        caster_take_ambient(c, points, (float)CASTER_AMBIENT_SHARE, light);
    }
    if ((takes & CASTER_TAKES_DIRECT) != 0) {
        caster_take_direct(c, points, (float)CASTER_DIRECT_SHARE, light);
    }
}

static void shade_tile(const caster *c, int32_t takes, soft_shade_tile *tile)
{
    const caster_points points = {tile->x, tile->y, tile->z, tile->count};
    shade_points(c, takes, &points, tile->light);
    if (tile->has_edge) {
        const caster_points nearer = {tile->x, tile->y, tile->near_z, tile->count};
        shade_points(c, takes, &nearer, tile->near_light);
    }
    tile->is_shaded = true;
}

static void shade_by(shade_band *b, const caster *c, const pixel_rect *r)
{
    int32_t takes[CASTER_LANES];
    if (r->y0 >= b->end || r->y1 <= b->begin) {
        return;
    }
    const int32_t end = (r->x1 + WIDTH - 1) / WIDTH;
    for (int32_t first = r->x0 / WIDTH; first < end; first += CASTER_LANES) {
        const int32_t count = at_most(end - first, CASTER_LANES);
        for (int32_t k = first; k < first + count; k++) {
            if (!b->tiles[k].is_known) {
                know_tile(b, k);
            }
        }
        const caster_balls balls = {b->x + first, b->y + first, b->z + first, b->radius + first};
        caster_may_take_balls(c, &balls, CASTER_LANES, takes);
        for (int32_t k = 0; k < count; k++) {
            if (takes[k] != CASTER_TAKES_NOTHING && b->tiles[first + k].has_depth) {
                shade_tile(c, takes[k], &b->tiles[first + k]);
            }
        }
    }
}

RLF_KERNEL_PART uint32_t darkened(uint32_t byte, float light)
{
    return (uint32_t)(int32_t)((float)(int32_t)(byte & 255u) * light + 0.5f);
}

RLF_KERNEL static void darken(const float *restrict light, int32_t count, uint8_t *restrict bytes)
{
    uint32_t pixels[WIDTH];
    soft_load_pixels(bytes, count, pixels);
    for (int32_t i = 0; i < count; i++) {
        uint32_t p = pixels[i];
        pixels[i] = darkened(p, light[i]) | darkened(p >> 8, light[i]) << 8 |
                    darkened(p >> 16, light[i]) << 16 | (p & 0xff000000u);
    }
    soft_store_pixels(pixels, count, bytes);
}

/* Linear between nodes `step` pixels apart. */
RLF_KERNEL_PART void spread(const float *restrict node, int32_t step, float *restrict light)
{
    const float per_step = 1.0f / (float)step;
    for (int32_t k = 0; k < WIDTH / step; k++) {
        const float per_px = (node[k + 1] - node[k]) * per_step;
        for (int32_t x = 0; x < step; x++) {
            light[k * step + x] = node[k] + per_px * (float)x;
        }
    }
}

/* Light of a row of a tile, `row` pixels from its top. */
RLF_KERNEL static void spread_light(const soft_shade_tile *tile, int32_t row, float *restrict light)
{
    const int32_t step = tile->step;
    const int32_t columns = tile->columns;
    const float *above = tile->light + row / step * columns;
    float node[WIDTH / 4 + 1];
    if (step == 1) {
        memcpy(light, above, WIDTH * sizeof(*light));
        return;
    }
    const float down = (float)(row % step) / (float)step;
    for (int32_t k = 0; k < columns; k++) {
        node[k] = above[k] + (above[columns + k] - above[k]) * down;
    }
    if (step == 4) {
        spread(node, 4, light);
    } else {
        spread(node, 8, light);
    }
}

/* True when hardly any light is lost, in whole lanes. */
RLF_KERNEL static bool is_light(const float *restrict light, int32_t count)
{
    int32_t dark = 0;
    for (int32_t first = 0; first < count; first += SOFT_LANES) {
        RLF_KERNEL_WHOLE
        for (int32_t i = 0; i < SOFT_LANES; i++) {
            dark |= light[first + i] <= HARDLY ? 1 : 0;
        }
    }
    return dark == 0;
}

/* The matte's share of the nearer surface's light in row y, over the farther one's. */
static void mix_sides(const shade_band *b, int32_t column, int32_t y, int32_t count, float *light)
{
    const edge_matte *l = &b->s->edges;
    const soft_shade_tile *tile = &b->tiles[column];
    const float *nearer = tile->near_light + (ptrdiff_t)(y - b->begin) * WIDTH;
    const uint8_t *marks = l->marks + b->begin / EDGE_MATTE_TILE * l->columns;
    const uint8_t *cover = rlf_u8_row(&l->cover, y);
    for (int32_t i = 0; i < count; i++) {
        const int32_t x = column * WIDTH + i;
        if ((marks[x / EDGE_MATTE_TILE] & EDGE_MATTE_FILLED) != 0) {
            light[i] += (nearer[i] - light[i]) * (float)cover[x] * (1.0f / 255.0f);
        }
    }
}

static void darken_tile(const shade_band *b, int32_t column)
{
    const soft *s = b->s;
    const soft_shade_tile *tile = &b->tiles[column];
    if (is_light(tile->light, tile->count) &&
        !(tile->has_edge && !is_light(tile->near_light, tile->count))) {
        return;
    }
    int32_t x0 = column * WIDTH;
    int32_t count = at_most(WIDTH, s->camera.width - x0);
    float light[WIDTH];
    for (int32_t y = b->begin; y < b->end; y++) {
        spread_light(tile, y - b->begin, light);
        if (tile->has_edge) {
            mix_sides(b, column, y, count, light);
        }
        darken(light, count, rlf_rgba8_row(&s->image, y) + 4 * (ptrdiff_t)x0);
    }
}

void soft_draw_shadows(const soft *s, soft_shade_tile *tiles, int32_t begin, int32_t end)
{
    if (s->scene.caster_count == 0) {
        return;
    }
    shade_band b;
    int32_t columns = (s->camera.width + WIDTH - 1) / WIDTH;
    b.s = s;
    b.begin = begin;
    b.end = end;
    b.tiles = tiles;
    for (int32_t column = 0; column < columns + CASTER_LANES; column++) {
        b.x[column] = b.y[column] = b.z[column] = b.radius[column] = 0.0f;
    }
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
