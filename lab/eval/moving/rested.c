/* Bodies at rest in a room while the camera looks away from them and back.
 *
 * They are put on floor and furniture where the camera sees that they can stand, and have time to
 * come to rest. Then the camera goes its way. Sensed through the whole pipeline. */
#include "eval/moving/rested.h"

#include "eval/analytic.h"
#include "relief/io.h"
#include "relief/pipeline.h"

#define BODIES 500
#define TRIES 200000
#define PUT_FRAME 15  /* the room in view is known */
#define REST_FRAME 57 /* before the camera turns away */
#define FLUNG_M 0.05
#define SUNK_M 0.02
#define FARTHEST_M 3.0
#define EDGE_PX 8
#define UP_COS 0.98
#define FACING 0.2 /* cosine: at a lower angle the sensor shows next to nothing of a face */
#define RING 8

typedef struct rested_body {
    rlf_body_id id;
    rlf_vec3 home; /* where it was put */
    bool was_asleep, is_flung, is_sunk, is_woken;
} rested_body;

typedef struct resting {
    rlf_pool *pool;
    rlf_source *source;
    rlf_pipeline *pipeline;
    rlf_pipeline_output frame;
    eval_random random;
    rlf_vec3 up; /* world */
    rested_body bodies[BODIES];
    int32_t count;
} resting;

static rlf_result open_room(resting *r, const char *source)
{
    rlf_vec3 down;
    rlf_result result = rlf_pool_create(2, &r->pool);
    if (result == RLF_OK) {
        result = rlf_open_source(source, r->pool, &r->source);
    }
    if (result == RLF_OK) {
        result = rlf_synthetic_get_down(r->source, &down);
    }
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, r->source, r->pool);
        def.camera = RLF_CAMERA_MOVING;
        def.enable_render = false;
        def.world.border = RLF_BORDER_EXTEND;
        def.world.body_capacity = BODIES;
        def.world.gravity = rlf_scale(down, 9.81);
        r->up = rlf_neg(down);
        result = rlf_pipeline_create(&def, &r->pipeline);
    }
    return result;
}

static double distance_at(const resting *r, rlf_vec3 p)
{
    double distance = -1.0;
    (void)rlf_synthetic_distance(r->source, p, &distance, NULL, NULL);
    return distance;
}

/* Whether a body of that size stands at p, with room around; all in the camera's frame. */
static bool can_stand(const resting *r, rlf_vec3 p, rlf_vec3 up, double size)
{
    const double EVEN = 0.004;
    const rlf_vec3 any = {0.3, 0.1, 1.0};
    rlf_vec3 a = rlf_normalize(rlf_cross(up, any)), b = rlf_cross(up, a);
    if (distance_at(r, rlf_mad(p, up, size)) < 0.9 * size) {
        return false;
    }
    for (int32_t k = 0; k < RING; k++) {
        double angle = 2.0 * RLF_PI * k / RING;
        rlf_vec3 at = rlf_mad(rlf_mad(p, a, size * rlf_cos(angle)), b, size * rlf_sin(angle));
        double low = distance_at(r, at), high = distance_at(r, rlf_mad(at, up, 0.5 * size));
        if (low > EVEN || low < -EVEN || high < 0.4 * size) {
            return false;
        }
    }
    return true;
}

/* A place in view on which a body of that size can stand; camera's frame. */
static bool pick_place(resting *r, rlf_vec3 up, double size, rlf_vec3 *out)
{
    const rlf_truth *truth = rlf_source_get_truth(r->source);
    const rlf_camera *camera = &rlf_source_get_info(r->source)->rig.depth;
    for (int32_t i = 0; i < TRIES; i++) {
        int32_t x = (int32_t)eval_random_range(&r->random, EDGE_PX, camera->width - EDGE_PX);
        int32_t y = (int32_t)eval_random_range(&r->random, EDGE_PX, camera->height - EDGE_PX);
        int32_t k = y * camera->width + x;
        double z = (double)truth->depth[k];
        rlf_vec3 ray, n = rlf_vec3_make(truth->normal_x[k], truth->normal_y[k], truth->normal_z[k]);
        if (!(z > 0.5 && z < FARTHEST_M) || rlf_dot(n, up) < UP_COS ||
            !rlf_camera_unproject(camera, x, y, &ray) || -rlf_dot(n, rlf_normalize(ray)) < FACING) {
            continue;
        }
        *out = rlf_scale(ray, z / ray.z);
        if (can_stand(r, *out, up, size)) {
            return true;
        }
    }
    return false;
}

/* They do not meet each other: places are few. */
static rlf_result put_body(resting *r)
{
    const rlf_pose *T = &r->frame.T_world_camera;
    rlf_body_def def = rlf_body_def_default();
    double size = eval_random_range(&r->random, 0.04, 0.12);
    bool is_ball = eval_random_uniform(&r->random) < 0.5;
    rlf_vec3 place, up = rlf_rotate(rlf_quat_conjugate(T->q), r->up);
    if (!pick_place(r, up, size, &place)) {
        return RLF_OK;
    }
    def.shape = (rlf_shape){.type = is_ball ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX};
    def.shape.radius = 0.5 * size;
    def.shape.size = rlf_vec3_make(size, size, size);
    def.orientation = rlf_quat_from_rotation_vector(
        rlf_scale(r->up, eval_random_range(&r->random, 0.0, 2.0 * RLF_PI)));
    def.restitution = 0.2;
    def.rolling_resistance = 0.2;
    def.collides_with_bodies = false;
    def.position = rlf_mad(rlf_transform(T, place), r->up, 0.5 * size + 0.003);
    rested_body *b = &r->bodies[r->count++];
    b->home = def.position;
    return rlf_world_add_body(rlf_pipeline_get_world(r->pipeline), &def, &b->id);
}

static const rlf_body_state *find_body(const resting *r, rlf_body_id id)
{
    const rlf_snapshot *s = r->frame.snapshot;
    for (int32_t k = 0; k < s->body_count; k++) {
        if (s->bodies[k].id.index1 == id.index1) {
            return &s->bodies[k];
        }
    }
    return NULL;
}

static void follow(resting *r)
{
    for (int32_t k = 0; k < r->count; k++) {
        rested_body *b = &r->bodies[k];
        const rlf_body_state *now = find_body(r, b->id);
        if (now == NULL) {
            continue;
        }
        if (r->frame.frame_index == REST_FRAME) {
            b->was_asleep = now->is_asleep;
        }
        rlf_vec3 way = rlf_sub(now->T_world_body.p, b->home);
        b->is_flung = b->is_flung || rlf_length(way) > FLUNG_M;
        b->is_sunk = b->is_sunk || rlf_dot(way, r->up) < -SUNK_M;
        b->is_woken = b->is_woken || (b->was_asleep && !now->is_asleep);
    }
}

static rlf_result play(resting *r)
{
    rlf_result result = rlf_pipeline_step(r->pipeline, &r->frame);
    while (result == RLF_OK) {
        for (int32_t k = 0; k < BODIES && r->frame.frame_index == PUT_FRAME; k++) {
            result = result == RLF_OK ? put_body(r) : result;
        }
        follow(r);
        result = result == RLF_OK ? rlf_pipeline_step(r->pipeline, &r->frame) : result;
    }
    return result == RLF_END ? RLF_OK : result;
}

static void add_figures(const resting *r, rested_figures *out)
{
    out->put += r->count;
    for (int32_t k = 0; k < r->count; k++) {
        const rested_body *b = &r->bodies[k];
        out->lost += find_body(r, b->id) == NULL;
        out->flung += b->is_flung;
        out->sunk += b->is_sunk;
        out->woken += b->is_woken;
    }
}

rlf_result rested_measure(const char *source, int64_t seed, rested_figures *out)
{
    resting *r = rlf_alloc(sizeof(*r));
    if (r == NULL) {
        return RLF_ERROR_MEMORY;
    }
    r->random = eval_random_start((uint64_t)seed);
    rlf_result result = open_room(r, source);
    result = result == RLF_OK ? play(r) : result;
    if (result == RLF_OK) {
        add_figures(r, out);
    }
    rlf_pipeline_destroy(&r->pipeline);
    rlf_source_destroy(&r->source);
    rlf_pool_destroy(&r->pool);
    rlf_free(r);
    return result;
}
