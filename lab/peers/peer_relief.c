/* Relief itself, by both of its methods. */
#include "peer.h"

#include <stdlib.h>

typedef struct engine {
    rlf_world *world;
    rlf_body_id *ids;
    int32_t count;
} engine;

static void close_engine(void *context)
{
    engine *e = context;
    rlf_world_destroy(&e->world);
    free(e->ids);
    free(e);
}

static void *open_engine(rlf_vec3 gravity, int32_t capacity, rlf_physics_method method)
{
    rlf_world_def def = rlf_world_def_default();
    def.method = method;
    def.gravity = gravity;
    def.body_capacity = capacity;
    def.contact_capacity = 32 * capacity + 256;
    def.border = RLF_BORDER_EXTEND;
    engine *e = calloc(1, sizeof(*e));
    if (e == NULL) {
        return NULL;
    }
    e->ids = calloc((size_t)capacity, sizeof(*e->ids));
    if (e->ids == NULL || rlf_world_create(&def, &e->world) != RLF_OK) {
        close_engine(e);
        return NULL;
    }
    return e;
}

static void *open_live(rlf_vec3 gravity, int32_t capacity)
{
    return open_engine(gravity, capacity, RLF_PHYSICS_LIVE);
}

static void *open_thesis(rlf_vec3 gravity, int32_t capacity)
{
    return open_engine(gravity, capacity, RLF_PHYSICS_THESIS);
}

static bool add(void *context, const peer_body *body)
{
    engine *e = context;
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_scale(body->half, 2.0);
    if (body->radius > 0.0) {
        def.shape.type = RLF_SHAPE_SPHERE;
        def.shape.radius = body->radius;
    }
    def.is_kinematic = body->mass == 0.0;
    def.mass = def.is_kinematic ? 1.0 : body->mass;
    def.position = body->pose.p;
    def.orientation = body->pose.q;
    def.velocity = body->v;
    def.angular_velocity = body->w;
    def.friction = body->friction;
    def.restitution = body->restitution;
    return rlf_world_add_body(e->world, &def, &e->ids[e->count++]) == RLF_OK;
}

static void step(void *context, double dt, const rlf_grid *grid)
{
    engine *e = context;
    rlf_world_advance(e->world, grid, dt);
}

static peer_state state(const void *context, int32_t body)
{
    const engine *e = context;
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(e->world);
    peer_state s = {.pose = rlf_pose_identity(), .is_gone = true};
    for (int32_t i = 0; i < snapshot->body_count; i++) {
        const rlf_body_state *b = &snapshot->bodies[i];
        if (b->id.index1 == e->ids[body].index1) {
            return (peer_state){b->T_world_body, b->velocity, b->angular_velocity, false};
        }
    }
    return s;
}

const peer peer_live = {"live", true, open_live, close_engine, add, NULL, step, state};
const peer peer_thesis = {"thesis", false, open_thesis, close_engine, add, NULL, step, state};
