/* One face for several physics engines, so that each plays the same scenes. */
#ifndef RLF_BENCH_PEER_H
#define RLF_BENCH_PEER_H

#include "relief/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A box, or a ball when radius > 0; fixed when mass is 0. */
typedef struct peer_body {
    rlf_vec3 half;
    double radius, mass, friction, restitution;
    rlf_pose pose;
    rlf_vec3 v, w;
} peer_body;

/* A triangle mesh, which the engine may not keep. */
typedef struct peer_mesh {
    const float *vertices; /* x, y, z */
    const uint32_t *triangles;
    int32_t vertex_count, triangle_count;
} peer_mesh;

typedef struct peer_state {
    rlf_pose pose;
    rlf_vec3 v, w;
    bool is_gone;
} peer_state;

typedef struct peer {
    const char *name;
    bool plays_bodies; /* has fixed bodies to stand on, and a crowd */
    void *(*open)(rlf_vec3 gravity, int32_t capacity); /* NULL: no memory */
    void (*close)(void *engine);
    bool (*add)(void *engine, const peer_body *body);
    /* Replaces layer 0 (what stays) or 1 (what moves); NULL: the engine takes the grid itself. */
    bool (*set_mesh)(void *engine, int32_t layer, const peer_mesh *mesh);
    void (*step)(void *engine, double dt, const rlf_grid *grid);
    peer_state (*state)(const void *engine, int32_t body); /* of the body that was added as such */
} peer;

extern const peer peer_live, peer_thesis, peer_ode, peer_bullet;

#define PEER_STEP (1.0 / 60.0)
#define PEER_SPEEDS 4

/* Room for the mesh of a grid. */
typedef struct peer_mesher {
    float *vertices;
    uint32_t *triangles;
} peer_mesher;

bool peer_mesher_open(peer_mesher *out, const rlf_grid *grid);
void peer_mesher_close(peer_mesher *mesher);
/* Two triangles for each square of pixels, but none across an edge. It is the mesher's. */
peer_mesh peer_mesh_of(peer_mesher *mesher, const rlf_grid *grid, const rlf_grid_sheet *sheet);

/* What a crowd cost, ms per 1/60 s, and how many of its cubes were lost in view. */
typedef struct peer_cost {
    double median_ms, p95_ms;
    int32_t lost;
} peer_cost;

/* Cubes fall on the room while a person walks through it. */
bool peer_crowd(const peer *p, int32_t count, double seconds, uint64_t seed, peer_cost *out);

/* How many times of 2 * PEER_SPEEDS a rising plate carries a box or a ball and throws it, and a
 * board pushes one before it. */
bool peer_push(const peer *p, int32_t *out_lifted, int32_t *out_swept);

#ifdef __cplusplus
}
#endif

#endif
