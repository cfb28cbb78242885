/* Cells, eight voxels of up to eight blocks; and with them distance and gradient at a point. */
#include "map/volume.h"

#include <string.h>

bool map_cell_read(const map_volume *v, int32_t block, int32_t i, int32_t j, int32_t k,
                   map_cell *out)
{
    const int32_t *after = v->after[block];
    const int32_t last = MAP_SIDE - 1;
    const bool is_inner = (i < last) & (j < last) & (k < last);
    const int32_t base = (k * MAP_SIDE + j) * MAP_SIDE + i;
    int32_t known = 1;
    for (int32_t c = 0; c < 8; c++) {
        const int32_t dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
        int32_t voxel = base + dx + dy * MAP_SIDE + dz * MAP_SIDE * MAP_SIDE;
        int32_t owner = block;
        if (!is_inner) {
            const int32_t x = i + dx, y = j + dy, z = k + dz;
            owner = after[(x >> 3) | (y >> 3) << 1 | (z >> 3) << 2];
            voxel = ((z & last) * MAP_SIDE + (y & last)) * MAP_SIDE + (x & last);
            if (owner < 0) {
                out->block[c] = NULL;
                out->weight[c] = 0;
                known = 0;
                continue;
            }
        }
        const map_block *b = map_block_at(v, owner);
        out->block[c] = b;
        out->voxel[c] = (int16_t)voxel;
        out->distance[c] = (float)b->distance[voxel] * (1.0f / RLF_FUSE_STEPS);
        out->weight[c] = b->weight[voxel];
        known &= b->weight[voxel] > 0;
    }
    return known != 0;
}

/* The block of the cell about a point, or -1: the voxel at its lowest corner, counted from the
 * world's, and the place in it. */
static int32_t cell_about(const rlf_map *map, rlf_vec3 p, int32_t voxel[3], double in[3])
{
    const double scale = 1.0 / map->def.voxel_m, most = 32000.0 * MAP_SIDE;
    const double at[3] = {p.x * scale, p.y * scale, p.z * scale};
    for (int32_t k = 0; k < 3; k++) {
        if (!(at[k] > -most && at[k] < most)) {
            return -1;
        }
        voxel[k] = map_floor(at[k]);
        in[k] = at[k] - voxel[k];
    }
    return map_volume_find(&map->volume, map_block_of(voxel[0]), map_block_of(voxel[1]),
                           map_block_of(voxel[2]));
}

int32_t map_voxel_near(const rlf_map *map, rlf_vec3 p, int32_t *out_voxel)
{
    const double half = 0.5 * map->def.voxel_m;
    int32_t voxel[3] = {0};
    double in[3];
    const int32_t block = cell_about(map, rlf_add(p, rlf_vec3_make(half, half, half)), voxel, in);
    *out_voxel = ((voxel[2] & 7) * MAP_SIDE + (voxel[1] & 7)) * MAP_SIDE + (voxel[0] & 7);
    return block;
}

static uint8_t clamped(int32_t x)
{
    return (uint8_t)(x < 0 ? 0 : (x > 255 ? 255 : x));
}

void map_voxel_color(const map_block *block, int32_t voxel, uint8_t rgba[4])
{
    const int32_t x = voxel & 7, y = voxel >> 3 & 7, z = voxel >> 6;
    const int32_t cell = ((z >> 1) * 4 + (y >> 1)) * 4 + (x >> 1);
    const int32_t luma = block->grey[voxel];
    const int32_t blue = luma + 2 * (block->chroma[0][cell] - 128);
    const int32_t red = luma + 2 * (block->chroma[1][cell] - 128);
    /* luma = (77 R + 150 G + 29 B) / 256 */
    const int32_t green = (256 * luma - 77 * red - 29 * blue) / 150;
    rgba[0] = clamped(red);
    rgba[1] = clamped(green);
    rgba[2] = clamped(blue);
    rgba[3] = luma > 0 ? 255 : 0;
}

static void tell(const rlf_map *map, double distance, rlf_map_point *out)
{
    out->state = distance > 0.0 ? RLF_MAP_FREE : RLF_MAP_INSIDE;
    out->distance = distance * map->def.voxel_m;
}

rlf_map_point rlf_map_sample(const rlf_map *map, rlf_vec3 p_world)
{
    rlf_map_point out;
    memset(&out, 0, sizeof(out));
    if (!RLF_ASSERT(map != NULL) || !rlf_vec3_is_finite(p_world)) {
        return out;
    }
    int32_t voxel[3];
    double at[3];
    const int32_t block = cell_about(map, p_world, voxel, at);
    if (block < 0) {
        return out;
    }
    map_cell cell;
    memset(&cell, 0, sizeof(cell));
    if (!map_cell_read(&map->volume, block, voxel[0] & 7, voxel[1] & 7, voxel[2] & 7, &cell)) {
        const int32_t near =
            (at[0] >= 0.5 ? 1 : 0) | (at[1] >= 0.5 ? 2 : 0) | (at[2] >= 0.5 ? 4 : 0);
        if (cell.weight[near] > 0) { /* where not all is known the nearest voxel answers */
            tell(map, (double)cell.distance[near], &out);
        }
        return out;
    }
    float g[3];
    const float in[3] = {(float)at[0], (float)at[1], (float)at[2]};
    const double d = (double)map_cell_value(cell.distance, in, g);
    tell(map, d, &out);
    out.is_far = d >= 0.95 * MAP_TRUNCATION_LEAST || d <= -0.95 * MAP_TRUNCATION_LEAST;
    const rlf_vec3 gradient = {(double)g[0], (double)g[1], (double)g[2]};
    /* A flat field, cut at the truncation, has no direction. */
    if (rlf_dot(gradient, gradient) > 0.04) {
        out.gradient = rlf_normalize(gradient);
    }
    return out;
}
