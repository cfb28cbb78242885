/* LIFT, SWIPE, CARRY from rest: what has stood since the first frame starts to move, and carries or
 * pushes what lies on or before it. */
#include "command.h"
#include "eval/analytic.h"
#include "eval/measures/percent.h"
#include "eval/sections.h"
#include "eval/start/room.h"
#include "eval/table.h"
#include "relief/pipeline.h"

#define CASES 6    /* per speed and seed, two with each sensor */
#define SIZE 0.1   /* m, of the cubes */
#define PLACED 0.7 /* s; the cube is put down ... */
#define BEGIN 1.5  /* ... and the box begins to move */
#define FRAME_S (1.0 / 30)

typedef enum start_kind { START_LIFT = 0, START_SWIPE, START_CARRY, START_KINDS } start_kind;

#define SPEEDS 5

static const double speeds[SPEEDS] = {0.1, 0.25, 0.5, 1.0, 2.0};

static const struct {
    const char *key, *title;
} rows[START_KINDS][SPEEDS] = {{{"lift_10", "LIFT: carried upwards from rest, at 0.1 m/s, %"},
                                {"lift_25", "  at 0.25 m/s, %"},
                                {"lift_50", "  at 0.5 m/s, %"},
                                {"lift_100", "  at 1 m/s, %"},
                                {"lift_200", "  at 2 m/s, %"}},
                               {{"swipe_10", "SWIPE: pushed by a board from rest, at 0.1 m/s, %"},
                                {"swipe_25", "  at 0.25 m/s, %"},
                                {"swipe_50", "  at 0.5 m/s, %"},
                                {"swipe_100", "  at 1 m/s, %"},
                                {"swipe_200", "  at 2 m/s, %"}},
                               {{"carry_10", "CARRY: carried along from rest, at 0.1 m/s, %"},
                                {"carry_25", "  at 0.25 m/s, %"},
                                {"carry_50", "  at 0.5 m/s, %"},
                                {"carry_100", "  at 1 m/s, %"},
                                {"carry_200", "  at 2 m/s, %"}}};

/* A plate or low box that stands on the floor and rises, or is pushed along it; or a board. */
static start_def draw_case(eval_random *r, start_kind kind, double speed)
{
    start_def def = {.speed = speed, .begin_s = BEGIN, .far = 0.3, .ramp_s = 1e-3};
    bool is_swipe = kind == START_SWIPE;
    def.height = eval_random_range(r, 0.5, 1.4);
    double z = eval_random_range(r, 1.1, 1.7), tall = eval_random_range(r, 0.04, 0.3);
    double x = eval_random_range(r, -0.15, 0.15), drop = def.height - (is_swipe ? 0.15 : tall);
    def.pitch = rlf_atan2(drop, z) + eval_random_range(r, -0.1, 0.1);
    rlf_vec3 half = {eval_random_range(r, 0.15, 0.3), 0.5 * tall, eval_random_range(r, 0.12, 0.25)};
    def.box.yaw = eval_random_range(r, -0.8, 0.8);
    if (is_swipe) {
        half =
            rlf_vec3_make(eval_random_range(r, 0.15, 0.25), eval_random_range(r, 0.1, 0.2), 0.02);
        bool is_left = eval_random_uniform(r) < 0.5;
        def.box.yaw = (is_left ? -1.0 : 1.0) * eval_random_range(r, 0.0, 1.1);
    }
    def.box.half = half;
    def.box.centre = rlf_vec3_make(x, def.height - half.y, z);
    double along = eval_random_range(r, 0.0, 6.283);
    def.way = kind == START_LIFT ? rlf_vec3_make(0, -1, 0)
              : kind == START_CARRY
                  ? rlf_vec3_make(rlf_cos(along), 0, rlf_sin(along))
                  : rlf_vec3_make(-rlf_sin(def.box.yaw), 0, -rlf_cos(def.box.yaw));
    def.ramp_s = kind == START_CARRY ? rlf_max(0.1, speed / 2.5) : def.ramp_s;
    def.far += 0.5 * speed * def.ramp_s;
    return def;
}

/* On the box, a little off its middle; or before the board. */
static rlf_vec3 place_of(const start_def *def, start_kind kind, eval_random *r)
{
    double u = eval_random_range(r, -0.3, 0.3) * def->box.half.x;
    rlf_vec3 along = {rlf_cos(def->box.yaw), 0, -rlf_sin(def->box.yaw)};
    rlf_vec3 p = rlf_mad(def->box.centre, along, u);
    if (kind == START_SWIPE) {
        p = rlf_mad(p, def->way, def->box.half.z + 0.72 * SIZE + 0.01);
        p.y = def->height - 0.5 * SIZE - 0.01;
    } else {
        p.y = def->box.centre.y - def->box.half.y - 0.5 * SIZE - 0.01;
    }
    return p;
}

typedef struct start_run {
    start_room room;
    rlf_pipeline *pipeline;
    rlf_pipeline_output frame;
} start_run;

static rlf_result open_run(const start_def *def, start_run *run)
{
    rlf_result result = start_room_open(def, &run->room);
    if (result == RLF_OK) {
        rlf_pipeline_def pipeline =
            rlf_pipeline_def_default(RLF_PROFILE_LIVE, run->room.source, NULL);
        pipeline.enable_render = false;
        pipeline.world.border = RLF_BORDER_EXTEND;
        pipeline.T_world_camera = run->room.T_world_camera;
        result = rlf_pipeline_create(&pipeline, &run->pipeline);
    }
    return result;
}

static rlf_result step_until(start_run *run, double time)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK && (run->frame.surface == NULL || run->frame.time_s < time - 1e-6)) {
        result = command_interrupted ? RLF_END : rlf_pipeline_step(run->pipeline, &run->frame);
    }
    return result;
}

static bool is_within(double value, double least, double most)
{
    return value >= least && value <= most;
}

/* As the box stops: the cube is on it, where it was put, and as fast; or before the board and
 * pushed as far. */
static bool is_right(const start_run *run, start_kind kind, rlf_vec3 placed)
{
    const start_def *def = &run->room.def;
    double speed;
    const rlf_snapshot *s = run->frame.snapshot;
    start_box box = start_box_at(def, run->frame.time_s, &speed);
    rlf_vec3 p = s->bodies[0].T_world_body.p, at = start_box_local(&box, p);
    rlf_vec3 was = start_box_local(&def->box, placed);
    double along = rlf_dot(s->bodies[0].velocity, def->way);
    if (kind == START_SWIPE) {
        double moved = rlf_dot(rlf_sub(p, placed), def->way);
        return at.z < -def->box.half.z && moved > 0.7 * def->far && along > 0.7 * speed;
    }
    double gap = -at.y - def->box.half.y - 0.5 * SIZE;
    double slip = kind == START_LIFT ? 0.05 : 0.1;
    bool is_there = is_within(at.x - was.x, -slip, slip) && is_within(at.z - was.z, -slip, slip);
    return is_there && is_within(gap, -0.02, 0.02) &&
           is_within(along - speed, -0.1 * speed - 0.03, 0.1 * speed + 0.03);
}

static rlf_result run_case(const start_def *def, start_kind kind, eval_random *r, bool *out_good)
{
    start_run run = {.pipeline = NULL};
    rlf_body_def body = rlf_body_def_default();
    body.shape = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {SIZE, SIZE, SIZE}};
    body.position = place_of(def, kind, r);
    body.orientation = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), def->box.yaw);
    body.restitution = 0.2;
    *out_good = false;
    rlf_result result = open_run(def, &run);
    result = result == RLF_OK ? step_until(&run, PLACED) : result;
    rlf_world *world = result == RLF_OK ? rlf_pipeline_get_world(run.pipeline) : NULL;
    rlf_body_id id;
    result = result == RLF_OK ? rlf_world_add_body(world, &body, &id) : result;
    double stop = BEGIN + def->far / def->speed + 0.5 * def->ramp_s;
    result = result == RLF_OK ? step_until(&run, stop - FRAME_S) : result;
    *out_good = result == RLF_OK && run.frame.snapshot->body_count == 1 &&
                is_right(&run, kind, body.position);
    rlf_pipeline_destroy(&run.pipeline);
    start_room_close(&run.room);
    return result;
}

static rlf_result add_row(eval_table *table, int64_t seed, start_kind kind, int speed)
{
    int64_t right = 0;
    rlf_result result = RLF_OK;
    for (int k = 0; k < CASES && result == RLF_OK; k++) {
        eval_random r = eval_random_start((uint64_t)(seed * 1000 + kind * 100 + k));
        start_def def = draw_case(&r, kind, speeds[speed]);
        def.sensor = (start_sensor)(k % START_SENSORS);
        def.seed = (uint64_t)(seed * 1000 + k + 1);
        bool is_good = false;
        result = run_case(&def, kind, &r, &is_good);
        right += is_good;
    }
    if (result == RLF_OK) {
        eval_table_add(table, "start", rows[kind][speed].key, rows[kind][speed].title,
                       RLF_PROFILE_LIVE, eval_percent(right, CASES));
    }
    return result;
}

rlf_result eval_start_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = RLF_OK;
    for (int kind = 0; kind < START_KINDS && (profile_mask & (1 << RLF_PROFILE_LIVE)); kind++) {
        for (int speed = 0; speed < SPEEDS && result == RLF_OK; speed++) {
            result = add_row(table, seed, (start_kind)kind, speed);
        }
    }
    return result;
}
