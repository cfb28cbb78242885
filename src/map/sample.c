/* Distance and gradient at a point. */
#include "map/volume.h"

#include <string.h>

static double floored(double x)
{
    double i = (double)(int64_t)x;
    return x < i ? i - 1.0 : i;
}

/* Where not all of a cell is known, its nearest voxel answers. */
static rlf_map_point nearest_voxel(const rlf_map *map, const map_cell *cell, const double at[3])
{
    rlf_map_point out;
    memset(&out, 0, sizeof(out));
    const int32_t c = (at[0] >= 0.5 ? 1 : 0) | (at[1] >= 0.5 ? 2 : 0) | (at[2] >= 0.5 ? 4 : 0);
    if (cell->block[c] == NULL || cell->weight[c] == 0) {
        return out;
    }
    const double d = (double)cell->distance[c];
    out.state = d > 0.0 ? RLF_MAP_FREE : RLF_MAP_INSIDE;
    out.distance = d * map->def.voxel_m;
    return out;
}

rlf_map_point rlf_map_sample(const rlf_map *map, rlf_vec3 p_world)
{
    rlf_map_point out;
    memset(&out, 0, sizeof(out));
    if (!RLF_ASSERT(map != NULL) || !rlf_vec3_is_finite(p_world)) {
        return out;
    }
    const double scale = 1.0 / map->def.voxel_m, most = 32000.0 * MAP_SIDE;
    double at[3] = {p_world.x * scale, p_world.y * scale, p_world.z * scale};
    int32_t voxel[3], block_at[3];
    for (int32_t k = 0; k < 3; k++) {
        if (!(at[k] > -most && at[k] < most)) {
            return out;
        }
        const double whole = floored(at[k]);
        voxel[k] = (int32_t)whole;
        at[k] -= whole;
        block_at[k] = (voxel[k] - (voxel[k] & 7)) / MAP_SIDE;
    }
    const int32_t block = map_volume_find(&map->volume, block_at[0], block_at[1], block_at[2]);
    if (block < 0) {
        return out;
    }
    map_cell cell;
    memset(&cell, 0, sizeof(cell));
    if (!map_cell_read(&map->volume, block, voxel[0] & 7, voxel[1] & 7, voxel[2] & 7, &cell)) {
        return nearest_voxel(map, &cell, at);
    }
    float g[3];
    const float in[3] = {(float)at[0], (float)at[1], (float)at[2]};
    const double d = (double)map_cell_value(cell.distance, in, g);
    out.state = d > 0.0 ? RLF_MAP_FREE : RLF_MAP_INSIDE;
    out.distance = d * map->def.voxel_m;
    out.is_far = d >= 0.95 * MAP_TRUNCATION_LEAST || d <= -0.95 * MAP_TRUNCATION_LEAST;
    const rlf_vec3 gradient = {(double)g[0], (double)g[1], (double)g[2]};
    /* A flat field, cut at the truncation, has no direction. */
    if (rlf_dot(gradient, gradient) > 0.04) {
        out.gradient = rlf_normalize(gradient);
    }
    return out;
}
