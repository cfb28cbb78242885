/* Bodies thrown at the boxes of the room from behind, where the camera sees nothing, and from
 * before them: do they bounce off, and does any get inside? */
#include "eval/known/bounce.h"

#include "eval/analytic.h"
#include "eval/known/room.h"
#include "eval/table.h"

#include <string.h>

#define THROWS 12 /* at each box, from each side */
#define SIDES 2   /* from behind, from the camera's side */
#define SPEED 2.0 /* m/s */
#define START_M 0.45
#define RELEASE_S 0.5
#define FRAMES 45
#define FRAME_S (1.0 / 30.0)
#define RADIUS 0.04
#define INSIDE_M 0.02 /* so far in it is not on the surface */
#define AIR_M 0.035   /* so far out it bounced off air; a cube's corner is that far from its ball */

typedef struct bounce {
    int32_t model;
    rlf_vec3 direction;          /* of its flight */
    rlf_vec3 position, velocity; /* in the frame before */
    double deepest;              /* metres below the true surface */
    bool is_back;                /* from behind */
    bool is_returned;            /* it flew back */
} bounce;

typedef struct bounce_case {
    bool has_models, is_lost;
    const char *keys[3], *titles[3];
} bounce_case;

static const bounce_case cases[4] = {
    {false,
     false,
     {"plain_back_percent", "plain_front_percent", "plain_inside_percent"},
     {"thrown at unseen backs, no model: bounced, %", "  at seen fronts: bounced, %",
      "  got more than 2 cm inside, %"}},
    {true,
     false,
     {"back_percent", "front_percent", "inside_percent"},
     {"  with models: unseen backs, %", "  seen fronts, %", "  got more than 2 cm inside, %"}},
    {false,
     true,
     {"lost_plain_back_percent", "lost_plain_front_percent", "lost_plain_inside_percent"},
     {"boxes without depth, no model: backs, %", "  fronts, %", "  got more than 2 cm inside, %"}},
    {true,
     true,
     {"lost_back_percent", "lost_front_percent", "lost_inside_percent"},
     {"  with models: backs, %", "  fronts, %", "  got more than 2 cm inside, %"}}};

/* A ball or a cube that flies straight at the middle of a box, give or take a quarter of its size.
 */
static rlf_body_def aim(int32_t model, bool is_back, int32_t number, eval_random *random,
                        bounce *out)
{
    const rlf_known_def def = known_true_model(model);
    rlf_vec3 at = rlf_vec3_make(0.3 * def.shape.size.x * eval_random_range(random, -0.5, 0.5),
                                0.3 * def.shape.size.y * eval_random_range(random, -0.5, 0.5), 0.0);
    rlf_vec3 target = rlf_transform(&def.T_world_model, at);
    rlf_vec3 axis = rlf_rotate(def.T_world_model.q, rlf_vec3_make(0, 0, is_back ? -1.0 : 1.0));
    rlf_body_def body = rlf_body_def_default();
    body.shape = (rlf_shape){.type = number % 2 == 0 ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX,
                             .radius = RADIUS,
                             .size = {2 * RADIUS, 2 * RADIUS, 2 * RADIUS}};
    body.gravity_scale = 0.0;
    body.collides_with_bodies = false;
    body.release_time = RELEASE_S;
    body.velocity = rlf_scale(axis, SPEED);
    body.position = rlf_mad(target, axis, -START_M);
    *out = (bounce){.model = model,
                    .direction = axis,
                    .position = body.position,
                    .deepest = -1.0,
                    .is_back = is_back};
    return body;
}

/* Metres below the true surface of a body there. */
static double depth_of(const bounce *b, rlf_vec3 position)
{
    const rlf_known_def def = known_true_model(b->model);
    rlf_vec3 gradient;
    rlf_vec3 p = rlf_transform_inverse(&def.T_world_model, position);
    return RADIUS - rlf_shape_distance(&def.shape, p, &gradient);
}

/* Where a body turned back since the last frame: it flew straight to there and from there. */
static rlf_vec3 turning_point(const bounce *b, const rlf_body_state *body)
{
    double before = rlf_dot(b->velocity, b->direction);
    double after = rlf_dot(body->velocity, b->direction);
    double way = rlf_dot(rlf_sub(body->T_world_body.p, b->position), b->direction);
    double time = rlf_clamp((way - after * FRAME_S) / (before - after), 0.0, FRAME_S);
    return rlf_mad(b->position, b->velocity, time);
}

static void follow(bounce *b, const rlf_body_state *body)
{
    bool is_back = rlf_dot(body->velocity, b->direction) < -0.02 * SPEED;
    if (is_back && !b->is_returned) {
        b->deepest = rlf_max(b->deepest, depth_of(b, turning_point(b, body)));
    }
    b->deepest = rlf_max(b->deepest, depth_of(b, body->T_world_body.p));
    b->is_returned = b->is_returned || is_back;
    b->position = body->T_world_body.p;
    b->velocity = body->velocity;
}

/* What came of the throws at all boxes. */
typedef struct bounce_counts {
    int32_t thrown[SIDES], returned[SIDES], inside;
} bounce_counts;

static rlf_result fly(rlf_pipeline *pipeline, bounce *bounces, int32_t count)
{
    rlf_result result = RLF_OK;
    for (int i = 0; i < FRAMES && result == RLF_OK; i++) {
        rlf_pipeline_output frame;
        result = rlf_pipeline_step(pipeline, &frame);
        for (int32_t k = 0; k < count && result == RLF_OK; k++) {
            if (k < frame.snapshot->body_count) {
                follow(&bounces[k], &frame.snapshot->bodies[k]);
            }
        }
    }
    return result;
}

static rlf_result measure(const bounce_case *c, int64_t seed,
                          const rlf_known_def models[KNOWN_MODELS], bounce_counts *out)
{
    rlf_known_def copies[KNOWN_MODELS];
    rlf_body_def bodies[KNOWN_MODELS * SIDES * THROWS];
    bounce bounces[KNOWN_MODELS * SIDES * THROWS];
    eval_random random = eval_random_start((uint64_t)seed + 5);
    int32_t count = 0;
    memcpy(copies, models, sizeof(copies));
    for (int32_t i = 0; i < KNOWN_MODELS * SIDES * THROWS; i++) {
        bodies[count] =
            aim(i % KNOWN_MODELS, i / KNOWN_MODELS % SIDES == 0, i / 6, &random, &bounces[count]);
        count++;
    }
    const rlf_scene scene = {.bodies = bodies,
                             .body_count = count,
                             .known = copies,
                             .known_count = c->has_models ? KNOWN_MODELS : 0};
    rlf_source *source = NULL, *room = NULL;
    rlf_pipeline *pipeline = NULL;
    rlf_result result = known_open_room(seed, c->is_lost, &source, &room);
    if (result == RLF_OK) {
        rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
        def.enable_render = false;
        def.scene = &scene;
        result = rlf_pipeline_create(&def, &pipeline);
    }
    if (result == RLF_OK) {
        result = fly(pipeline, bounces, count);
    }
    *out = (bounce_counts){.inside = 0};
    for (int32_t i = 0; i < count; i++) {
        int side = bounces[i].is_back ? 0 : 1;
        out->thrown[side]++;
        out->returned[side] +=
            bounces[i].is_returned && bounces[i].deepest < INSIDE_M && bounces[i].deepest > -AIR_M;
        out->inside += bounces[i].deepest > INSIDE_M;
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_source_destroy(&source);
    return result;
}

rlf_result known_run_bounce(eval_table *table, int64_t seed,
                            const rlf_known_def models[KNOWN_MODELS])
{
    for (int i = 0; i < 4; i++) {
        bounce_counts n;
        rlf_result result = measure(&cases[i], seed, models, &n);
        if (result != RLF_OK) {
            return result;
        }
        const double values[3] = {100.0 * n.returned[0] / n.thrown[0],
                                  100.0 * n.returned[1] / n.thrown[1],
                                  100.0 * n.inside / (n.thrown[0] + n.thrown[1])};
        for (int k = 0; k < 3; k++) {
            eval_table_add(table, "known", cases[i].keys[k], cases[i].titles[k], RLF_PROFILE_LIVE,
                           values[k]);
        }
    }
    return RLF_OK;
}
