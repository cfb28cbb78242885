/* Bodies thrown about a room while the camera turns away from them and back: where they are then.
 *
 * The room is fused from the noisy frames of a path, with true poses. Then the camera goes the same
 * way again, bodies are thrown into what it sees, and it stands still until all of them lie. */
#include "eval/moving/thrown.h"

#include "eval/analytic.h"
#include "eval/moving/seen.h"
#include "fuse/fuser.h"

#include "relief/io.h"

#include <stdio.h>

#define SOURCE "synthetic:empty?path=look_away&color=320x180&fps=10&frames=62&seed=%lld"
#define BODIES 1000
#define POSES_MAX 128
#define STEPS 3     /* of physics between two poses, a thirtieth of a second each */
#define THROWING 40 /* poses during which bodies are thrown */
#define STANDING 60 /* steps in which the camera stands at the end */
#define STEP_S (1.0 / 30)
#define AT_REST_M 0.01

typedef struct throwing {
    rlf_source *source;
    fuser fuser;
    rlf_pool *pool;
    rlf_pose poses[POSES_MAX];
    int32_t pose_count;
    seen_room seen;
    rlf_world *world;
    eval_random random;
    int32_t steps;
    double surface_ms;
} throwing;

static rlf_result fuse(throwing *t, int64_t seed)
{
    const fuser_options options = {.has_time = true};
    char text[160];
    (void)snprintf(text, sizeof(text), SOURCE, (long long)seed);
    rlf_result result = rlf_open_source(text, t->pool, &t->source);
    if (result == RLF_OK) {
        result = fuser_open(&t->fuser, &rlf_source_get_info(t->source)->rig, &options, t->pool);
    }
    while (result == RLF_OK && t->pose_count < POSES_MAX) {
        rlf_frame frame;
        result = rlf_source_next(t->source, &frame);
        if (result == RLF_OK) {
            t->poses[t->pose_count++] = frame.T_world_camera;
            result = fuser_add(&t->fuser, &frame, &frame.T_world_camera, NULL);
        }
    }
    return result == RLF_END ? RLF_OK : result;
}

static rlf_result make_world(throwing *t)
{
    rlf_world_def def = rlf_world_def_default();
    def.body_capacity = BODIES;
    def.border = RLF_BORDER_EXTEND;
    def.pool = t->pool;
    rlf_vec3 down;
    rlf_result result = rlf_synthetic_get_down(t->source, &down);
    const rlf_pose *last = &t->poses[t->pose_count - 1];
    def.gravity = rlf_scale(rlf_rotate(last->q, down), 9.81);
    if (result == RLF_OK) {
        result = rlf_world_create(&def, &t->world);
    }
    if (result == RLF_OK) {
        rlf_world_set_room(t->world, t->fuser.map);
        seen_room_start(&t->seen, t->source, last);
    }
    return result;
}

/* A cube or a ball from free space in view, anywhere up to 2 m away. */
static rlf_result throw_body(throwing *t)
{
    rlf_body_def def = rlf_body_def_default();
    double size = eval_random_range(&t->random, 0.04, 0.12);
    bool is_ball = eval_random_uniform(&t->random) < 0.5;
    def.shape = (rlf_shape){.type = is_ball ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX};
    def.shape.radius = 0.5 * size;
    def.shape.size = rlf_vec3_make(size, size, size);
    def.restitution = 0.3;
    def.rolling_resistance = 0.1;
    def.collides_with_bodies = false;
    do {
        rlf_vec3 p = {0, 0, eval_random_range(&t->random, 0.6, 2.0)};
        p.x = eval_random_range(&t->random, -0.5, 0.5) * p.z;
        p.y = eval_random_range(&t->random, -0.4, 0.4) * p.z;
        def.position = rlf_transform(&t->seen.grid.T_world_grid, p);
    } while (seen_room_distance(&t->seen, def.position) < size);
    def.velocity = eval_random_in_box(&t->random, rlf_vec3_make(-4, -2, -4), rlf_vec3_make(4, 2, 4));
    def.angular_velocity =
        eval_random_in_box(&t->random, rlf_vec3_make(-5, -5, -5), rlf_vec3_make(5, 5, 5));
    return rlf_world_add_body(t->world, &def, NULL);
}

/* Between two poses of the path. */
static rlf_pose pose_at(const throwing *t, int32_t step)
{
    int32_t last = t->pose_count - 1, k = step / STEPS < last ? step / STEPS : last;
    const rlf_pose *a = &t->poses[k], *b = &t->poses[k < last ? k + 1 : last];
    double share = (double)(step % STEPS) / STEPS;
    rlf_quat q = {a->q.x + share * (b->q.x - a->q.x), a->q.y + share * (b->q.y - a->q.y),
                  a->q.z + share * (b->q.z - a->q.z), a->q.w + share * (b->q.w - a->q.w)};
    return (rlf_pose){rlf_mad(a->p, rlf_sub(b->p, a->p), share), rlf_quat_normalize(q)};
}

static rlf_result play(throwing *t)
{
    int32_t thrown = 0, moving = (t->pose_count - 1) * STEPS;
    rlf_result result = RLF_OK;
    for (int32_t step = 0; step < moving + STANDING && result == RLF_OK; step++) {
        const rlf_pose pose = pose_at(t, step);
        result = seen_room_look(&t->seen, &pose);
        int32_t due = (step + 1) * BODIES / (THROWING * STEPS);
        for (due = due < BODIES ? due : BODIES; thrown < due && result == RLF_OK; thrown++) {
            result = throw_body(t);
        }
        rlf_world_advance(t->world, &t->seen.grid, STEP_S);
        t->surface_ms += rlf_world_get_times(t->world).surface_ms;
        t->steps++;
    }
    return result;
}

/* How far the body's lowest place is over the true surface, metres. */
static double gap_of(const throwing *t, const rlf_body_state *body)
{
    if (body->shape.type == RLF_SHAPE_SPHERE) {
        return seen_room_distance(&t->seen, body->T_world_body.p) - body->shape.radius;
    }
    double least = 1e9, half = 0.5 * body->shape.size.x;
    for (int32_t k = 0; k < 8; k++) {
        rlf_vec3 corner =
            rlf_vec3_make(k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half);
        rlf_vec3 p = rlf_transform(&body->T_world_body, corner);
        least = rlf_min(least, seen_room_distance(&t->seen, p));
    }
    return least;
}

static void judge(const throwing *t, thrown_figures *out)
{
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(t->world);
    int32_t resting = 0;
    *out = (thrown_figures){.gone = BODIES - snapshot->body_count};
    for (int32_t k = 0; k < snapshot->body_count; k++) {
        const rlf_body_state *body = &snapshot->bodies[k];
        double gap = gap_of(t, body);
        bool is_off = !(gap < AT_REST_M && gap > -AT_REST_M);
        resting += body->is_asleep;
        out->sunk += is_off && gap < 0.0;
        out->hanging += is_off && gap > 0.0;
        if (is_off) {
            rlf_vec3 p = body->T_world_body.p;
            fprintf(stderr, "  thrown %d: %.3f m over the room at %.2f %.2f %.2f%s\n", (int)k, gap,
                    p.x, p.y, p.z, body->is_asleep ? ", asleep" : "");
        }
    }
    out->restless = snapshot->body_count - resting;
    out->surface_ms = t->surface_ms / t->steps;
}

rlf_result thrown_measure(int64_t seed, thrown_figures *out)
{
    throwing *t = rlf_alloc(sizeof(*t));
    if (t == NULL) {
        return RLF_ERROR_MEMORY;
    }
    t->random = eval_random_start((uint64_t)seed);
    rlf_result result = rlf_pool_create(1, &t->pool);
    if (result == RLF_OK) {
        result = fuse(t, seed);
    }
    if (result == RLF_OK) {
        result = make_world(t);
    }
    if (result == RLF_OK) {
        result = play(t);
    }
    if (result == RLF_OK) {
        judge(t, out);
    }
    rlf_world_destroy(&t->world);
    fuser_close(&t->fuser);
    rlf_source_destroy(&t->source);
    rlf_pool_destroy(&t->pool);
    rlf_free(t);
    return result;
}
