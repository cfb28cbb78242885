/* A map of the room as the background of a standing camera, in place of a memory per pixel. */
#ifndef RELIEF_APP_EVAL_MEMORY_MAP_MEMORY_H
#define RELIEF_APP_EVAL_MEMORY_MAP_MEMORY_H

#include "relief/map.h"
#include "relief/reconstruct.h"

/* The map, what it predicts, and per pixel how far the depth that is seen is from that: voxels are
 * coarser than what a pixel averages over time. */
typedef struct map_memory {
    rlf_map *map;
    rlf_camera camera;
    int32_t count; /* pixels of all planes */
    float *given;  /* prediction and residual, metres; 0 = unknown */
    float *predicted;
    float *residual; /* running mean of depth less prediction */
    uint8_t *samples;
    uint8_t *is_static;
    rlf_prediction prediction;
    bool has_prediction, has_residual;
    bool is_changed; /* the map, since it predicted */
} map_memory;

/* For a surface stage at scale factor 1. On failure everything is closed again. */
rlf_result map_memory_open(const rlf_rig *rig, bool has_residual, map_memory *out);
void map_memory_close(map_memory *m);
/* The def's background is the map's from now on; m must outlive the stage. */
void map_memory_use(map_memory *m, rlf_reconstruct_def *def);
/* Fuses a surface of that stage: what is not foreground. */
rlf_result map_memory_fuse(map_memory *m, const rlf_surface *s);

#endif
