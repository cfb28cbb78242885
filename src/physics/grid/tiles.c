/* Making tiles. */
#include "physics/grid/tiles.h"
#include "kernel/kernel.h"
#include "physics/grid/field.h"

#define SIZE_MIN 16
#define BLOCK_SHIFT_MIN 2  /* SIZE_MIN / TILE_BLOCKS is 4 */
#define SAMPLES_PER_SIDE 4 /* pixels of a tile that give its plane */
/* Beyond the tile's own pixels: an outline is told from the pixel beside it. */
#define RIM_PX 2
/* Beyond the tile's own pixels, too: so far the width of what is narrow is followed. */
#define NARROW_PX 8
/* Far more than a float of some metres is rounded by: metres, and a share. */
#define ROUNDING 1e-5
#define NOWHERE 1e30
#define BLOCKS (TILE_BLOCKS * TILE_BLOCKS)

void grid_tiles_start(grid_tiles *tiles, const rlf_grid *grid, const rlf_grid_sheet *sheet,
                      bool is_new)
{
    if (is_new || tiles->sheet == NULL) {
        tiles->stamp++;
    }
    tiles->sheet = sheet;
    tiles->size = SIZE_MIN;
    tiles->block_shift = BLOCK_SHIFT_MIN - 1;
    do {
        tiles->columns = (grid->width - 1) / tiles->size + 1;
        tiles->rows = (grid->height - 1) / tiles->size + 1;
        tiles->size *= 2;
        tiles->block_shift++;
    } while (tiles->columns * tiles->rows > TILES_MAX);
    tiles->size /= 2;
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t most(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

/* Counts the pixels that have a surface and finds the box about them. */
static void measure(grid_tile *tile, const rlf_grid *grid, const rlf_grid_sheet *sheet,
                    const int32_t rect[4])
{
    const float FAR = 1e9f;
    float low[3] = {FAR, FAR, FAR}, high[3] = {-FAR, -FAR, -FAR};
    int32_t count = 0;
    for (int32_t y = rect[1]; y < rect[3]; y++) {
        int32_t row = y * grid->width;
        const uint8_t *mask = sheet->mask != NULL ? sheet->mask + row : NULL;
        for (int32_t x = rect[0]; x < rect[2]; x++) {
            float z = sheet->depth[row + x];
            if (z > 0.0f && (mask == NULL || mask[x] != 0)) {
                const float p[3] = {z * grid->ray_x[row + x], z * grid->ray_y[row + x], z};
                for (int32_t k = 0; k < 3; k++) {
                    low[k] = p[k] < low[k] ? p[k] : low[k];
                    high[k] = p[k] > high[k] ? p[k] : high[k];
                }
                count++;
            }
        }
    }
    tile->count = count;
    tile->near_z = low[2];
    tile->box.min = rlf_vec3_make(low[0], low[1], low[2]);
    tile->box.max = rlf_vec3_make(high[0], high[1], high[2]);
}

/* The box about what a pixel shows of its face. */
static rlf_aabb face_of(const rlf_grid *grid, const field_cell *cell)
{
    double half = grid_cell_half(grid, cell, 1);
    rlf_vec3 wide = rlf_vec3_make(half, half, half);
    return (rlf_aabb){rlf_sub(cell->point, wide), rlf_add(cell->point, wide)};
}

/* The box about the solid behind a pixel, whichever way it goes. */
static void extend(rlf_aabb *solid, const rlf_grid *grid, const field_cell *cell)
{
    double along = cell->thickness / cell->point.z;
    rlf_vec3 inward = grid_cell_inward(cell);
    rlf_aabb face = face_of(grid, cell);
    rlf_aabb_extend(solid, face.min);
    rlf_aabb_extend(solid, face.max);
    rlf_aabb_extend(solid, rlf_mad(cell->point, cell->point, along));
    rlf_aabb_extend(solid, rlf_mad(cell->point, inward, cell->thickness));
}

/* No part of the solid behind a pixel is farther below its face, metres. */
static double depth_of(const field_cell *cell)
{
    return cell->thickness * (cell->is_guess ? 1.0 : rlf_length(cell->point) / cell->point.z);
}

static void set_block(grid_blocks *blocks, int32_t block, const rlf_aabb *box)
{
    const double low[3] = {box->min.x, box->min.y, box->min.z};
    const double high[3] = {box->max.x, box->max.y, box->max.z};
    for (int32_t k = 0; k < 3; k++) {
        double size = rlf_max(low[k] < 0.0 ? -low[k] : low[k], high[k] < 0.0 ? -high[k] : high[k]);
        double slack = ROUNDING + ROUNDING * rlf_min(size, FIELD_ENDLESS);
        blocks->low[k][block] = (float)rlf_clamp(low[k] - slack, -NOWHERE, NOWHERE);
        blocks->high[k][block] = (float)rlf_clamp(high[k] + slack, -NOWHERE, NOWHERE);
    }
}

/* What is read of a row of a tile's pixels, most often a line of memory each. */
RLF_KERNEL_PART void fetch_row(const rlf_grid_sheet *sheet, int32_t i)
{
    RLF_KERNEL_SOON(&sheet->normal_x[i]);
    RLF_KERNEL_SOON(&sheet->normal_y[i]);
    RLF_KERNEL_SOON(&sheet->normal_z[i]);
    if (sheet->velocity_x != NULL) {
        RLF_KERNEL_SOON(&sheet->velocity_x[i]);
        RLF_KERNEL_SOON(&sheet->velocity_y[i]);
        RLF_KERNEL_SOON(&sheet->velocity_z[i]);
    }
    if (sheet->thickness != NULL) {
        RLF_KERNEL_SOON(&sheet->thickness[i]);
    }
    if (sheet->label != NULL) {
        RLF_KERNEL_SOON(&sheet->label[i]);
    }
    if (sheet->mask != NULL) {
        RLF_KERNEL_SOON(&sheet->mask[i]);
    }
}

/* The boxes about the solids behind the pixels, and their highest speed. */
static void bound(grid_tile *tile, const rlf_grid *grid, const rlf_grid_sheet *sheet,
                  const int32_t rect[4], int32_t shift)
{
    const rlf_aabb none = rlf_aabb_empty();
    rlf_aabb solids[BLOCKS];
    for (int32_t block = 0; block < BLOCKS; block++) {
        solids[block] = none;
    }
    tile->is_endless = false;
    tile->speed = tile->deepest = 0.0;
    for (int32_t y = rect[1]; y < rect[3]; y++) {
        rlf_aabb *row = &solids[((y - rect[1]) >> shift) * TILE_BLOCKS];
        fetch_row(sheet, (y + 2 < rect[3] ? y + 2 : y) * grid->width + rect[0]);
        for (int32_t x = rect[0]; x < rect[2]; x++) {
            field_cell cell;
            if (grid_cell_read(grid, sheet, x, y, &cell)) {
                extend(&row[(x - rect[0]) >> shift], grid, &cell);
                tile->is_endless = tile->is_endless || cell.thickness >= FIELD_ENDLESS;
                tile->deepest = rlf_max(tile->deepest, depth_of(&cell));
                tile->speed = rlf_max(tile->speed, rlf_dot(cell.velocity, cell.velocity));
            }
        }
    }
    tile->speed = sqrt(tile->speed);
    tile->solid = tile->box;
    for (int32_t block = 0; block < BLOCKS; block++) {
        if (solids[block].min.x <= solids[block].max.x) {
            rlf_aabb_extend(&tile->solid, solids[block].min);
            rlf_aabb_extend(&tile->solid, solids[block].max);
        }
        set_block(&tile->blocks, block, &solids[block]);
    }
    tile->near_z = rlf_min(tile->near_z, tile->solid.min.z);
}

uint32_t grid_tile_blocks_near(const grid_tile *tile, rlf_vec3 p, double reach)
{
    const float reach2 = (float)(reach * reach * (1.0 + ROUNDING));
    const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
    float distance2[BLOCKS] = {0.0f};
    uint32_t near = 0;
    for (int32_t k = 0; k < 3; k++) {
        const float *low = tile->blocks.low[k], *high = tile->blocks.high[k];
        for (int32_t block = 0; block < BLOCKS; block++) {
            float before = low[block] - at[k], beyond = at[k] - high[block];
            float off = before > beyond ? before : beyond;
            off = off > 0.0f ? off : 0.0f;
            distance2[block] += off * off;
        }
    }
    for (int32_t block = 0; block < BLOCKS; block++) {
        near |= (uint32_t)(distance2[block] <= reach2) << block;
    }
    return near;
}

static bool is_masked_out(const rlf_grid *grid, const uint8_t *mask, const int32_t rect[4])
{
    uint8_t any = 0;
    for (int32_t y = rect[1]; y < rect[3]; y++) {
        for (int32_t x = rect[0]; x < rect[2]; x++) {
            any |= mask[y * grid->width + x];
        }
    }
    return any == 0;
}

/* Mean plane and velocity of a few of its pixels; false when they have no normals. */
static bool fit(grid_tile *tile, const rlf_grid *grid, const rlf_grid_sheet *sheet,
                const int32_t rect[4])
{
    rlf_vec3 points = {0, 0, 0}, normals = {0, 0, 0}, velocities = {0, 0, 0};
    double count = 0.0;
    int32_t step_x = (rect[2] - rect[0]) / SAMPLES_PER_SIDE + 1;
    int32_t step_y = (rect[3] - rect[1]) / SAMPLES_PER_SIDE + 1;
    for (int32_t y = rect[1] + step_y / 2; y < rect[3]; y += step_y) {
        for (int32_t x = rect[0] + step_x / 2; x < rect[2]; x += step_x) {
            field_cell cell;
            if (grid_cell_read(grid, sheet, x, y, &cell)) {
                points = rlf_add(points, cell.point);
                normals = rlf_add(normals, cell.normal);
                velocities = rlf_add(velocities, cell.velocity);
                count += 1.0;
            }
        }
    }
    if (count < 4.0) {
        return false;
    }
    tile->normal = rlf_normalize(normals);
    tile->offset = rlf_dot(tile->normal, points) / count;
    tile->velocity = rlf_scale(velocities, 1.0 / count);
    return true;
}

/* Whether every pixel of the rectangle belongs to the sheet and lies on the tile's plane, but for
 * those without depth. */
static bool is_even(const grid_tile *tile, const rlf_grid *grid, const rlf_grid_sheet *sheet,
                    const int32_t rect[4])
{
    const float nx = (float)tile->normal.x, ny = (float)tile->normal.y, nz = (float)tile->normal.z;
    const float offset = (float)tile->offset, even = (float)(2.0 * GRID_MARGIN);
    for (int32_t y = rect[1]; y < rect[3]; y++) {
        int32_t row = y * grid->width;
        int32_t uneven = 0;
        for (int32_t x = rect[0]; x < rect[2]; x++) {
            float z = sheet->depth[row + x];
            float off = z * (nx * grid->ray_x[row + x] + ny * grid->ray_y[row + x] + nz) - offset;
            uneven += z > 0.0f && (off > even || off < -even);
        }
        for (int32_t x = rect[0]; sheet->mask != NULL && x < rect[2]; x++) {
            uneven += sheet->mask[row + x] == 0;
        }
        if (uneven > 0) {
            return false;
        }
    }
    return true;
}

/* Whether the sheet's surface at pixel i ends towards pixel `next`: at its rim or a step. */
static bool ends_towards(const rlf_grid_sheet *sheet, int32_t i, int32_t next)
{
    double z = sheet->depth[i];
    return (sheet->mask != NULL && sheet->mask[next] == 0) ||
           (double)sheet->depth[next] > z + grid_depth_step(z);
}

/* Length of the shortest run of pixels with an end on both sides, of those on a line of `count`
 * pixels from `begin`, `step` apart; `shortest` when there is no shorter one. A single pixel is
 * noise. */
static int32_t shortest_run(const rlf_grid_sheet *sheet, int32_t begin, int32_t step, int32_t count,
                            int32_t shortest)
{
    int32_t length = 0; /* 0: not after an end */
    for (int32_t k = 1; k + 1 < count; k++) {
        int32_t i = begin + k * step;
        bool is_there = sheet->depth[i] > 0.0f && (sheet->mask == NULL || sheet->mask[i] != 0);
        bool is_begun = is_there && (length > 0 || ends_towards(sheet, i, i - step));
        length = is_begun ? length + 1 : 0;
        if (length > 0 && ends_towards(sheet, i, i + step)) {
            shortest = length > 1 && length < shortest ? length : shortest;
            length = 0;
        }
    }
    return shortest;
}

/* Pixels across the narrowest thing in the tile, along rows or columns. */
static int32_t narrowest(const rlf_grid *grid, const rlf_grid_sheet *sheet, const int32_t own[4])
{
    int32_t x0 = most(own[0] - NARROW_PX, 0), x1 = least(own[2] + NARROW_PX, grid->width);
    int32_t y0 = most(own[1] - NARROW_PX, 0), y1 = least(own[3] + NARROW_PX, grid->height);
    int32_t shortest = most(x1 - x0, y1 - y0);
    for (int32_t y = own[1]; y < own[3]; y++) {
        shortest = shortest_run(sheet, y * grid->width + x0, 1, x1 - x0, shortest);
    }
    for (int32_t x = own[0]; x < own[2]; x++) {
        shortest = shortest_run(sheet, y0 * grid->width + x, grid->width, y1 - y0, shortest);
    }
    return shortest;
}

static tile_kind make_tile(grid_tile *tile, const grid_tiles *tiles, const rlf_grid *grid,
                           const int32_t at[2])
{
    int32_t x = at[0] * tiles->size, y = at[1] * tiles->size;
    const int32_t own[4] = {x, y, least(x + tiles->size, grid->width),
                            least(y + tiles->size, grid->height)};
    const int32_t wide[4] = {most(x - RIM_PX, 0), most(y - RIM_PX, 0),
                             least(own[2] + RIM_PX, grid->width),
                             least(own[3] + RIM_PX, grid->height)};
    const uint8_t *mask = tiles->sheet->mask;
    tile->count = 0;
    if (mask == NULL || !is_masked_out(grid, mask, own)) {
        measure(tile, grid, tiles->sheet, own);
        bound(tile, grid, tiles->sheet, own, tiles->block_shift);
    }
    if (tile->count == 0) {
        return TILE_EMPTY;
    }
    bool is_flat = fit(tile, grid, tiles->sheet, own) && is_even(tile, grid, tiles->sheet, wide);
    tile->narrow = is_flat ? tiles->size : narrowest(grid, tiles->sheet, own);
    return is_flat ? TILE_FLAT : TILE_ROUGH;
}

bool grid_tiles_make(grid_tiles *tiles, const rlf_grid *grid, const int32_t rect[4])
{
    bool is_any = false;
    if (tiles->sheet->depth == NULL || tiles->sheet->normal_x == NULL) {
        return false;
    }
    for (int32_t row = rect[1] / tiles->size; row * tiles->size < rect[3]; row++) {
        for (int32_t column = rect[0] / tiles->size; column * tiles->size < rect[2]; column++) {
            int32_t i = row * tiles->columns + column;
            const int32_t at[2] = {column, row};
            if (tiles->marks[i] >> 2 != tiles->stamp) {
                tile_kind kind = make_tile(&tiles->tiles[i], tiles, grid, at);
                tiles->marks[i] = tiles->stamp << 2 | (uint64_t)kind;
            }
            is_any = is_any || grid_tiles_kind(tiles, i) != TILE_EMPTY;
        }
    }
    return is_any;
}
