/* What is kept of depth from frame to frame, and the planes of the filling. */
#ifndef RLF_SURFACE_DEPTH_STATE_H
#define RLF_SURFACE_DEPTH_STATE_H

#include "base/arena.h"
#include "surface/frame.h"

/* Side of a block in pixels, and the frames without motion after which one is calm. */
enum { RLF_TEMPORAL_BLOCK = 8, RLF_TEMPORAL_CALM = 8 };

/* Means of inverse depth over time; NULL planes when they are not wanted. */
typedef struct temporal {
    float *mean, *frames;
    uint8_t *calm;     /* per block of RLF_TEMPORAL_BLOCK pixels, frames since something moved */
    uint8_t *restless; /* per block: 1 where it, or one beside it, is not calm */
    int32_t age;       /* frames that were averaged, up to 255 */
    uint8_t *change;   /* plane, scratch of temporal_recall.c */
    int8_t *lag;       /* plane, scratch of temporal_mean.c */
} temporal;

void temporal_allocate(temporal *state, rlf_arena *arena, const rlf_reconstruct_def *def,
                       const image_grid *grid);
void temporal_reset(temporal *state, const image_grid *grid);

#endif
