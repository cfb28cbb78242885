/* Bodies thrown about a room while the camera turns away from them and back: where they are then.
 *
 * A camera looks about from some places, with a sensor's noise and true poses: that is the map.
 * Then it turns over the room and back, and bodies are thrown into what it sees. */
#include "eval/moving/thrown.h"

#include "eval/analytic.h"
#include "eval/moving/seen.h"

#include "relief/io.h"
#include "relief/map.h"

#include <stdio.h>

/* Some path: then the room has walls on all sides. */
#define SOURCE "synthetic:empty?path=walk&color=0&noise=0&frames=1"
#define BODIES 1000
#define VOXEL_M 0.01
#define EYES 5      /* places from which the map is made */
#define TURNS 10    /* views a turn */
#define PANNING 100 /* steps that the camera takes over the room and back */
#define THROWING 80 /* steps in which bodies are thrown */
#define STANDING 90 /* steps in which the camera stands at the end */
#define STEP_S (1.0 / 30)
#define AT_REST_M 0.01

typedef struct throwing {
    rlf_source *source;
    rlf_map *map;
    rlf_pool *pool;
    seen_room seen;
    rlf_world *world;
    rlf_vec3 down;
    eval_random random;
    int32_t steps;
    double surface_ms;
} throwing;

static rlf_pose pose_of(rlf_vec3 eye, double yaw, double pitch)
{
    rlf_quat turn = rlf_quat_from_rotation_vector(rlf_vec3_make(0, yaw, 0));
    rlf_quat nod = rlf_quat_from_rotation_vector(rlf_vec3_make(-pitch, 0, 0));
    return (rlf_pose){eye, rlf_quat_mul(turn, nod)};
}

static rlf_result open_room(throwing *t)
{
    rlf_frame frame;
    rlf_result result = rlf_open_source(SOURCE, t->pool, &t->source);
    if (result == RLF_OK) {
        result = rlf_source_next(t->source, &frame);
    }
    if (result == RLF_OK) {
        result = rlf_synthetic_get_down(t->source, &t->down);
        seen_room_start(&t->seen, t->source, &frame.T_world_camera);
    }
    return result;
}

/* One view with a Kinect's noise. */
static rlf_result fuse_view(throwing *t, const rlf_depth_noise *noise, rlf_pose T)
{
    float depth[SEEN_PIXELS];
    rlf_result result = seen_room_look(&t->seen, &T);
    for (int32_t i = 0; i < SEEN_PIXELS; i++) {
        double z = (double)t->seen.depth[i];
        double sigma = rlf_depth_noise_sigma(noise, z);
        depth[i] = (float)(z > 0.0 ? z + sigma * eval_random_normal(&t->random) : 0.0);
    }
    const rlf_map_view view = {.depth = depth};
    return result == RLF_OK ? rlf_map_integrate(t->map, &view, &T, NULL) : result;
}

static rlf_result make_map(throwing *t)
{
    const rlf_vec3 eyes[EYES] = {
        {0, 0, 0}, {-1.2, 0, 1.2}, {1.2, 0, 1.6}, {1.9, 0, -0.2}, {-2.2, 0, 0.2}};
    const double pitches[3] = {-0.3, 0.3, 0.9};
    rlf_map_def def = rlf_map_def_default();
    def.rig = eval_kinect_rig();
    def.rig.depth = seen_room_camera();
    def.rig.depth_max_m = 8.0;
    def.voxel_m = VOXEL_M;
    def.blocks_per_frame = 0;
    rlf_result result = rlf_map_create(&def, &t->map);
    for (int32_t i = 0; i < EYES * 3 * TURNS && result == RLF_OK; i++) {
        double yaw = 2.0 * RLF_PI / TURNS * (i % TURNS);
        rlf_pose T = pose_of(eyes[i / TURNS / 3], yaw, pitches[i / TURNS % 3]);
        result = fuse_view(t, &def.rig.noise, T);
    }
    return result;
}

static rlf_result make_world(throwing *t)
{
    rlf_world_def def = rlf_world_def_default();
    def.body_capacity = BODIES;
    def.border = RLF_BORDER_EXTEND;
    def.pool = t->pool;
    def.gravity = rlf_scale(t->down, 9.81);
    rlf_result result = rlf_world_create(&def, &t->world);
    if (result == RLF_OK) {
        rlf_world_set_room(t->world, t->map);
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
    def.velocity =
        eval_random_in_box(&t->random, rlf_vec3_make(-4, -2, -4), rlf_vec3_make(4, 2, 4));
    def.angular_velocity =
        eval_random_in_box(&t->random, rlf_vec3_make(-5, -5, -5), rlf_vec3_make(5, 5, 5));
    return rlf_world_add_body(t->world, &def, NULL);
}

/* Over half of the room and back, then still. */
static rlf_pose pose_at(int32_t step)
{
    double share = step < PANNING ? (double)step / PANNING : 1.0;
    double yaw = 0.5 * RLF_PI * (1.0 - rlf_cos(2.0 * RLF_PI * share));
    return pose_of(rlf_vec3_make(0, 0, 0), yaw, 0.2);
}

static rlf_result play(throwing *t)
{
    int32_t thrown = 0;
    rlf_result result = RLF_OK;
    for (int32_t step = 0; step < PANNING + STANDING && result == RLF_OK; step++) {
        const rlf_pose pose = pose_at(step);
        result = seen_room_look(&t->seen, &pose);
        int32_t due = step < THROWING ? (step + 1) * BODIES / THROWING : BODIES;
        for (; thrown < due && result == RLF_OK; thrown++) {
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
        result = open_room(t);
    }
    if (result == RLF_OK) {
        result = make_map(t);
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
    rlf_map_destroy(&t->map);
    rlf_source_destroy(&t->source);
    rlf_pool_destroy(&t->pool);
    rlf_free(t);
    return result;
}
