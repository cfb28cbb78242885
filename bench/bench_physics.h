/* A live surface and showers of cubes on it, for benchmarks of physics. */
#ifndef RLF_BENCH_PHYSICS_H
#define RLF_BENCH_PHYSICS_H

#include "relief/reconstruct.h"
#include "relief/synthetic.h"
#include "relief/world.h"

#define ROOM_HZ 30
#define ROOM_REGIONS_MAX 256
#define SHOWER_LAYER 140 /* cubes dropped together */
#define SHOWER_LAYER_FRAMES                                                                        \
    6                 /* from layer to layer, so that nothing is dropped into the last one */
#define SHOWER_LOST 9 /* frames, 0.3 s, inside what stays: lost */

/* The synthetic room, reconstructed frame by frame. */
typedef struct room {
    rlf_source *source;
    rlf_reconstruct *reconstruct;
    rlf_grid_region regions[ROOM_REGIONS_MAX];
    rlf_grid grid; /* of the newest frame */
} room;

/* Opens the room and sees the frames in which it is still empty. */
bool room_open(room *r, uint64_t seed, int32_t scale_factor);
bool room_next(room *r);
void room_close(room *r);

/* A world into which cubes are dropped until there are `count`. */
typedef struct shower {
    rlf_world *world;
    int32_t count, added, step_count, step_capacity;
    double *step_ms;
    bool is_alone;         /* one worker */
    rlf_world_times times; /* sums */
    int32_t asleep_count, lost_count, alloc_count;
    int32_t hidden_count; /* of the lost: in what no picture shows */
    int32_t *inside;      /* per body: frames inside something that stays */
} shower;

/* The index-th cube: one of a layer under the ceiling, each turned in its own way. */
rlf_body_def shower_cube(int32_t index);

bool shower_open(shower *s, int32_t count, double seconds, rlf_pool *pool);
/* Drops cubes and advances by one frame in two steps of 1/60 s. */
bool shower_step(shower *s, room *r);
void shower_close(shower *s);

double shower_percentile(const shower *s, double percent);
double shower_busiest_second(const shower *s);

#endif
