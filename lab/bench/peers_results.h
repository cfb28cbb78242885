/* Stages of other libraries and of ours, as times and quality figures: what their harness prints.
 */
#ifndef RELIEF_APP_BENCH_PEERS_RESULTS_H
#define RELIEF_APP_BENCH_PEERS_RESULTS_H

#include "relief/reconstruct.h"

#define PEER_STAGES_MAX 160
#define PEER_VALUES_MAX 8
#define PEER_GROUPS 4

/* A quality figure: the harness's key, and the head of its column. */
typedef struct peer_column {
    const char *key, *head;
} peer_column;

/* One stage of the surface and what its table shows. `steps` of ours do it. */
typedef struct peer_group {
    char letter; /* the harness's stages begin with it */
    const char *title;
    const char *ours;
    uint32_t steps; /* bit of each rlf_surface_step */
    peer_column columns[PEER_VALUES_MAX];
} peer_group;

extern const peer_group peer_groups[PEER_GROUPS];

typedef struct peer_stage {
    char peer[24], stage[64];
    double ms, least_ms;
    double values[PEER_VALUES_MAX]; /* by the group's columns; NAN = none */
} peer_stage;

typedef struct peer_results {
    peer_stage stages[PEER_STAGES_MAX];
    int32_t count;
} peer_results;

/* NULL when the stage is of no group. */
const peer_group *peer_group_of(const char *stage);
/* The entry of a peer's stage, made when it is new; NULL when it is of no group or there is no
 * room. */
peer_stage *peer_stage_of(peer_results *r, const char *peer, const char *stage);
/* Adds the lines of a file behind what is there already. */
rlf_result peer_results_read(const char *path, peer_results *out);

#endif
