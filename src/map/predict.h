/* A view of the volume: eighths of blocks drawn as squares say where each ray begins. */
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
    /* In voxels: the eye, the way of pixel (0, 0)'s ray for a metre of depth, and what it gains
     * from pixel to pixel. */
    float at[3], way[3], way_x[3], way_y[3];
    float to_eighth[8][3]; /* from a block's corner to the middles of its eighths, camera frame */
    float step[3][3];      /* by voxels along x, y, z, camera frame, metres */
    map_view_planes *out;
    float per_metre; /* voxels */
    int32_t tile_columns;
    float slack; /* metres behind a drawn square where its surface still may be */
} map_caster;

/* Draws the blocks with a surface: farthest depth per tile, and into the plane of depth, per pixel,
 * one over the depth at which its ray may meet the nearest surface; 0 where there is none. */
void map_splat(map_caster *caster);

#endif
