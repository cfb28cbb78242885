/* Cells: eight voxels, of up to eight blocks. */
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
