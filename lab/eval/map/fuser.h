/* Frames with poses become a map: the surface stage cleans the depth, each depth pixel gets its
 * colour. */
#ifndef RELIEF_LAB_MAP_FUSER_H
#define RELIEF_LAB_MAP_FUSER_H

#include "pipeline/moving/moving.h"
#include "relief/io.h"

typedef struct fuser_options {
    double voxel_m;    /* 0 = the map's default */
    int32_t memory_mb; /* 0 = the map's default */
    bool has_time;     /* every frame into all of its blocks, as nobody waits */
    bool is_tracked;   /* the pose is found; false: the caller says it */
} fuser_options;

typedef struct fuser {
    rlf_map *map;
    rlf_reconstruct *stage;
    const rlf_rig *rig;
    const rlf_surface *surface; /* of the last frame; NULL before the first */
    color_view color;
    uint8_t *is_static; /* a depth pixel each; NULL when not tracked */
    bool is_tracked, has_fence;
    camera_pose pose;
    double surface_ms, color_ms, integrate_ms; /* of the last frame */
} fuser;

/* `rig` is borrowed. Close what was opened, also after an error. */
rlf_result fuser_open(fuser *f, const rlf_rig *rig, const fuser_options *options, rlf_pool *pool);
/* A frame and where the camera was; NULL where that is to be found: f->pose.last tells then what
 * was found, and a frame that is not placed well is not fused. `out_change` may be NULL. */
rlf_result fuser_add(fuser *f, const rlf_frame *frame, const rlf_pose *T_world_camera,
                     rlf_map_change *out_change);
void fuser_close(fuser *f);

#endif
