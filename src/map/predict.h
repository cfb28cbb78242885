/* Ray casting of a view, with the blocks' own depths as the range of every ray. */
#ifndef RLF_MAP_PREDICT_H
#define RLF_MAP_PREDICT_H

#include "map/volume.h"

#define MAP_TILE 8 /* pixels */

/* A camera that casts: world to voxels. */
typedef struct map_caster {
    const rlf_map *map;
    rlf_camera camera;
    rlf_mat3 R_world_camera, R_camera_world;
    rlf_vec3 eye; /* world, metres */
    map_view_planes *out;
    int32_t tile_columns;
} map_caster;

/* Nearest and farthest depth of the blocks with a surface, per tile. */
void map_tiles_fill(map_caster *caster);

#endif
