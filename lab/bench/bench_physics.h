/* A live surface and showers of cubes on it, for benchmarks of physics. */
#ifndef RLF_BENCH_PHYSICS_H
#define RLF_BENCH_PHYSICS_H

#include "relief/reconstruct.h"
#include "relief/synthetic.h"
#include "relief/world.h"

#include "pipeline/far_side.h"

#define ROOM_HZ 30
#define ROOM_REGIONS_MAX 256
#define SHOWER_LAYER 140 /* cubes dropped together */
#define SHOWER_LAYER_FRAMES                                                                        \
    6                     /* from layer to layer, so that nothing is dropped into the last one */
#define SHOWER_LOST 9     /* frames, 0.3 s, inside what stays: lost */
#define SHOWER_FALL 1.0   /* s in which the last layer falls */
#define SHOWER_SETTLE 2.0 /* s without a person, and s of these at the end that count as rest */
#define SHOWER_REST 1.0
#define SHOWER_DEEP 0.02 /* m of overlap that is told, and m in the person that count */

/* The synthetic room, reconstructed frame by frame. */
typedef struct room {
    uint64_t seed;
    rlf_source *source;
    rlf_reconstruct *reconstruct;
    rlf_grid_region regions[ROOM_REGIONS_MAX];
    rlf_grid grid; /* of the newest frame, with what its people hide, as in the pipeline */
    far_side far;
    double time_s; /* of the newest frame, since the source's first */
    int64_t first_time_ns;
    double grid_ms; /* what making `grid` out of the newest surface took */
} room;

/* Opens the room and sees the frames in which it is still empty. */
bool room_open(room *r, uint64_t seed, int32_t scale_factor);
bool room_next(room *r);
/* From the next frame on nobody is there. */
bool room_empty(room *r);
void room_close(room *r);

/* What happens to the cubes; see lab/measuring.md. */
typedef enum shower_phase {
    SHOWER_POURED,   /* they fall and bounce */
    SHOWER_PLOUGHED, /* all are there, and a person walks through them */
    SHOWER_AT_REST,  /* nobody is there */
    SHOWER_PHASES
} shower_phase;

typedef struct shower_cost {
    int32_t step_count;
    double median_ms, p95_ms, mean_ms;
} shower_cost;

/* A cube's way through the true person. */
typedef struct shower_passage {
    rlf_vec3 entry, last; /* of the solid: its normals where the centre got in and was last in */
    int32_t steps;        /* that the centre has been deep in it, at most SHOWER_LOST */
    bool is_inside, is_deep, is_through;
} shower_passage;

/* A world into which cubes are dropped until there are `count`. */
typedef struct shower {
    rlf_world *world;
    int32_t count, added, step_count, step_capacity;
    double *step_ms;
    double *grid_ms;   /* per frame: making the grid */
    double empty_time; /* s when the person goes */
    int64_t deep_sum;  /* over all frames: pairs of cubes that overlap by more than SHOWER_DEEP */
    bool is_alone;     /* one worker */
    rlf_world_times times; /* sums */
    int32_t asleep_count, lost_count, alloc_count;
    int32_t hidden_count;     /* of the lost: in what no picture shows */
    int32_t *inside;          /* per body: frames inside something that stays */
    int32_t through_count;    /* bodies that went through the person */
    shower_passage *passages; /* per body */
    rlf_vec3 *places[2];      /* per body: of its centre after the last frame, and in between */
} shower;

/* The index-th cube: one of a layer under the ceiling, each turned in its own way. */
rlf_body_def shower_cube(int32_t index);

/* `seconds` with the person, and SHOWER_SETTLE after them. */
bool shower_open(shower *s, int32_t count, double seconds, rlf_pool *pool);
/* Drops cubes and advances by one frame in two steps of 1/60 s. */
bool shower_step(shower *s, room *r);
void shower_close(shower *s);
/* Between the two steps of a frame: where the bodies are. */
void shower_note_places(shower *s);
/* After both: who is in the true person, and who has gone through it. */
void shower_look_for_passages(shower *s, const room *r);

/* Of the steps of a phase; all zero when the run was too short for it. */
shower_cost shower_cost_of(const shower *s, shower_phase phase);
/* That of the phase with the largest median. */
shower_cost shower_worst_cost(const shower *s);
/* Of all steps. */
double shower_worst_step(const shower *s);
double shower_busiest_second(const shower *s);
/* Mean milliseconds per 1/60 s that making the grids took. */
double shower_grid_mean(const shower *s);

/* The cost of `count` cubes on the same frames at scale factors 1, 2 and 4, and what it is of that
 * at 1. False when something failed. */
bool pixels_run(int32_t count, double seconds, uint64_t seed, rlf_pool *pool);

#endif
