/* A crowd on the live surface: Relief takes the grid, the others a mesh of each layer. What stays
 * is made into a mesh once, what moves in front of it in every frame. */
#define _POSIX_C_SOURCE 200809L
#include "bench_physics.h"
#include "peer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct crowd {
    const peer *p;
    void *engine;
    room room;
    int32_t count, added, frame, step_count;
    double *step_ms;
    int32_t *inside, lost;
    peer_mesher mesher;
} crowd;

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static void set_mesh(crowd *c, int32_t layer)
{
    const rlf_grid *grid = &c->room.grid;
    peer_mesh mesh =
        peer_mesh_of(&c->mesher, grid, layer == 0 ? &grid->background : &grid->foreground);
    c->p->set_mesh(c->engine, layer, &mesh);
}

static bool drop_layer(crowd *c)
{
    for (int32_t k = 0; k < SHOWER_LAYER && c->added < c->count; k++) {
        rlf_body_def def = shower_cube(c->added++);
        peer_body body = {.half = rlf_scale(def.shape.size, 0.5), .mass = def.mass};
        body.pose.p = def.position;
        body.pose.q = def.orientation;
        body.v = def.velocity;
        body.friction = def.friction;
        body.restitution = def.restitution;
        if (!c->p->add(c->engine, &body)) {
            return false;
        }
    }
    return true;
}

static bool is_in_view(const rlf_grid *grid, rlf_vec3 p)
{
    double u, v;
    return p.z > 0.0 && grid->project(grid->project_context, p, &u, &v) && u >= 0.0 && v >= 0.0 &&
           u < grid->width && v < grid->height;
}

/* 0.3 s inside floor, wall or furniture. Only in view: beyond it the meshes have no floor. */
static void count_lost(crowd *c)
{
    c->lost = 0;
    for (int32_t i = 0; i < c->added; i++) {
        peer_state s = c->p->state(c->engine, i);
        double distance = 1.0;
        rlf_vec3 normal;
        int32_t label = 0;
        rlf_synthetic_distance(c->room.source, s.pose.p, &distance, &normal, &label);
        bool is_in = distance < 0.0 && label < RLF_SYNTHETIC_LABEL_PERSON;
        is_in = is_in && !s.is_gone && is_in_view(&c->room.grid, s.pose.p);
        c->inside[i] = is_in || c->inside[i] >= SHOWER_LOST ? c->inside[i] + 1 : 0;
        c->inside[i] = c->inside[i] > SHOWER_LOST ? SHOWER_LOST : c->inside[i];
        c->lost += c->inside[i] >= SHOWER_LOST;
    }
}

/* A frame: the new surface, and two steps. What the surface costs the engine is a part of them. */
static bool play_frame(crowd *c)
{
    if (!room_next(&c->room) || (c->frame % SHOWER_LAYER_FRAMES == 0 && !drop_layer(c))) {
        return false;
    }
    double start = now_ms();
    if (c->p->set_mesh != NULL && c->frame == 0) {
        set_mesh(c, 0);
        start = now_ms();
    }
    if (c->p->set_mesh != NULL) {
        set_mesh(c, 1);
    }
    c->p->step(c->engine, PEER_STEP, &c->room.grid);
    c->p->step(c->engine, PEER_STEP, &c->room.grid);
    double own_ms = c->p->set_mesh == NULL ? c->room.grid_ms : 0.0;
    c->step_ms[c->step_count++] = 0.5 * (now_ms() - start + own_ms);
    c->frame++;
    count_lost(c);
    return true;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bool peer_crowd(const peer *p, int32_t count, double seconds, uint64_t seed, peer_cost *out)
{
    int32_t frames = (int32_t)(seconds * ROOM_HZ);
    crowd c = {.p = p, .count = count};
    bool is_good = room_open(&c.room, seed, 1);
    c.engine = is_good ? p->open(rlf_vec3_make(0, 9.81, 0), count) : NULL;
    c.step_ms = malloc((size_t)(frames + 1) * sizeof(*c.step_ms));
    c.inside = calloc((size_t)count, sizeof(*c.inside));
    is_good = c.engine != NULL && c.step_ms != NULL && c.inside != NULL &&
              peer_mesher_open(&c.mesher, &c.room.grid);
    for (int32_t k = 0; k < frames && is_good; k++) {
        is_good = play_frame(&c);
    }
    if (is_good) {
        qsort(c.step_ms, (size_t)c.step_count, sizeof(*c.step_ms), compare);
        *out = (peer_cost){c.step_ms[c.step_count / 2], c.step_ms[c.step_count * 95 / 100], c.lost};
    }
    if (c.engine != NULL) {
        p->close(c.engine);
    }
    free(c.step_ms);
    free(c.inside);
    peer_mesher_close(&c.mesher);
    room_close(&c.room);
    return is_good;
}
