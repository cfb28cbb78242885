/* The surface stage's own state: grid, ring of published surfaces, and the states of its modules.
 */
#ifndef RLF_SURFACE_STAGE_H
#define RLF_SURFACE_STAGE_H

#include "relief/reconstruct.h"

#include "kernel/kernel.h"
#include "surface/background/state.h"
#include "surface/depth/state.h"
#include "surface/motion/state.h"
#include "surface/normals/state.h"
#include "surface/thickness/state.h"
#include "surface/thin/thin.h"

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

/* What later steps of a frame, or those of the next one, go on with. */
typedef struct rlf_work {
    float *raw;         /* plane: depth as it came */
    float *kept;        /* plane: as planes are fitted to it: recalled, averaged, with holes */
    uint8_t *was_seen;  /* plane: 1 where that had a depth before holes were filled */
    uint8_t *links;     /* plane of RLF_LINK_ bits */
    int32_t *component; /* plane */
    rlf_span *front;    /* per row: where the foreground may be; finished with the background */
    rlf_runs runs;      /* of the layer that was segmented last */
    int32_t *parent;    /* count + 1 */
    int32_t *size;      /* count + 1 */
    int32_t *map;       /* count + 1 */
    int32_t *vote[2];   /* count + 1 */
    float *found;       /* plane, scratch of depth/fill.c */
    uint8_t *bits;      /* plane, scratch of segment.c */
    float *zeros;       /* one row */
    uint8_t *ones;      /* one row */
    uint8_t *missing;   /* one row of RLF_SEEN_MISSING */
    float *zero_plane;  /* published where there is no background */
    int32_t *zero_labels;
    struct rlf_region_sum *region_sums; /* region_capacity */
} rlf_work;

struct rlf_reconstruct {
    rlf_reconstruct_def def;
    image_grid grid;
    rlf_slot ring[RLF_RECONSTRUCT_SURFACES];
    int32_t current;          /* slot being made or last made */
    const rlf_slot *previous; /* slot of the frame before, NULL at the first */
    rlf_slot carried;         /* GIVEN: that, carried into this frame's camera */
    const rlf_slot *before;   /* GIVEN: slot of the frame before; previous = NULL until carried */
    int32_t next_label;
    rlf_sight sight;
    rlf_background background;
    temporal temporal;
    normals_state normals;
    rlf_tracks tracks; /* of the foreground */
    thin thin;         /* of the foreground */
    rlf_color_guide guide;
    struct rlf_objects *objects; /* see objects/objects.h; NULL = they are not wanted */
    rlf_ego_motion ego;
    rlf_shadow shadow;
    velocity_planes velocity;
    chord_planes chords;
    rlf_work work;
    bool has_components; /* work.runs holds the foreground's, so many: */
    int32_t component_count;
    rlf_surface_times *times; /* borrowed; NULL = not measured */
    int64_t clock_ns;         /* end of the last step that was timed */
    rlf_arena arena;
};

/* def.c */
rlf_result rlf_reconstruct_def_check(const rlf_reconstruct_def *def);

/* times.c: nanoseconds from the frame before to that of the slot, 0 to an hour: 0 at the first and
 * where time runs backwards. */
int64_t rlf_stage_elapsed_ns(const rlf_reconstruct *stage, const rlf_slot *slot);
/* The same in seconds; 0 when it is too long to follow anything, too. */
float rlf_stage_elapsed_s(const rlf_reconstruct *stage, const rlf_slot *slot);
/* Begins a frame's times; adds the time since the last call to a step. */
void rlf_stage_start_times(rlf_reconstruct *stage);
void rlf_stage_add_time(rlf_reconstruct *stage, rlf_surface_step step);

/* memory.c: allocates all buffers of a stage whose def is set; false when memory is short. */
bool rlf_stage_allocate(rlf_reconstruct *stage);
void rlf_stage_release(rlf_reconstruct *stage);

/* Rows per chunk of a parallel loop: even, and a multiple of the normal tiles. */
enum { RLF_ROW_GRAIN = 16 };

#endif
