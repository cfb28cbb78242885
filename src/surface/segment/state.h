/* What is kept of regions from frame to frame, and the planes of segmentation. */
#ifndef RLF_SURFACE_SEGMENT_STATE_H
#define RLF_SURFACE_SEGMENT_STATE_H

#include "base/arena.h"
#include "surface/frame.h"

/* A run of linked pixels of one row, the unit of segmentation. */
typedef struct rlf_run {
    int32_t x0, x1;
    int32_t component; /* > 0, 0 = none; later the number of its region */
} rlf_run;

/* Runs in raster order; row y has first[y] <= r < first[y + 1]. */
typedef struct rlf_runs {
    rlf_run *run;
    int32_t *first; /* height + 1 */
} rlf_runs;

/* A label that is in the picture or was until lately: see segment/region_track.c. */
typedef struct rlf_track {
    int32_t label;
    rlf_aabb box; /* where it is expected: as large as when it was last seen whole */
    rlf_vec3 velocity;
    double depth;              /* of its centroid */
    double points;             /* of it then, a little less each frame */
    int64_t age_ns, hidden_ns; /* how long it was followed; how long it has not been seen */
} rlf_track;

typedef struct rlf_tracks {
    rlf_track *item;
    int32_t count, capacity;
} rlf_tracks;

void tracks_allocate(rlf_tracks *state, rlf_arena *arena, const rlf_reconstruct_def *def);

#endif
