/* LIFT, SWIPE and CARRY of a thing that stood since the first frame, in random rooms. */
#include "eval/measures/percent.h"
#include "eval/random/random.h"
#include "eval/sensed/room.h"
#include "eval/table.h"

#include <stdio.h>
#include <string.h>

#define SIZE 0.1    /* m, of the cube */
#define START 3.0   /* s, the thing moves from then on */
#define PUT 1.8     /* s, the cube is put there */
#define RISE 0.4    /* m */
#define WAY 1.1     /* m, of the board */
#define AHEAD 0.6   /* m from the board to the cube */
#define TURNED 0.35 /* radians of the board against its way */
#define BOARD 0.5   /* m, its height */
#define HALF 0.012  /* m, of a plate's thickness */
#define CIRCLE 0.25 /* m, radius of a tray's way */
#define GAP 0.01    /* m that the cube is put above what it lands on */
#define SPEEDS 5

typedef enum push_kind { LIFT, SWIPE, CARRY, KINDS } push_kind;

static const double speeds[SPEEDS] = {0.1, 0.25, 0.5, 1.0, 2.0};

/* A random room with something that is pushed, and a cube put on or before it. */
typedef struct push {
    eval_room room;
    rlf_pose thing; /* at rest */
    rlf_vec3 down, way;
    double speed;
} push;

static bool find_pose(const push *p, const char *name, rlf_pose *out)
{
    const rlf_truth *truth = rlf_source_get_truth(p->room.truth);
    for (int32_t i = 0; i < truth->pose_count; i++) {
        if (strcmp(truth->poses[i].name, name) == 0) {
            *out = truth->poses[i].T_camera_object;
            return true;
        }
    }
    return false;
}

static rlf_result run_until(push *p, double time)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK &&
           (p->room.frame.surface == NULL || p->room.frame.time_s < time - 1e-6)) {
        result = eval_room_step(&p->room);
    }
    return result;
}

static const rlf_body_state *cube_of(const push *p)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(p->room.world);
    return s->body_count > 0 ? &s->bodies[0] : NULL;
}

static rlf_result put_cube(push *p, push_kind kind)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {SIZE, SIZE, SIZE}};
    def.orientation = p->thing.q;
    def.restitution = 0.2;
    def.angular_damping = 1.0;
    def.position = rlf_mad(p->thing.p, p->down, -(HALF + 0.5 * SIZE + GAP));
    if (kind == SWIPE) {
        const double lower = 0.5 * BOARD - 0.5 * SIZE;
        def.position = rlf_mad(rlf_mad(p->thing.p, p->way, AHEAD), p->down, lower);
    }
    rlf_body_id id;
    return rlf_world_add_body(p->room.world, &def, &id);
}

static rlf_result open_push(int64_t seed, push_kind kind, double speed, push *p)
{
    static const char *const keys[KINDS] = {"lift", "swipe", "carry"};
    static const char *const names[KINDS] = {"plate", "board", "tray"};
    char source[128];
    snprintf(source, sizeof(source),
             "synthetic:random?color=0&frames=-1&seed=%lld&push=%s&speed=%g", (long long)seed,
             keys[kind], speed);
    memset(p, 0, sizeof(*p));
    p->speed = speed;
    rlf_result result = eval_room_open(source, 0, RLF_PROFILE_LIVE, 0, &p->room);
    result = result == RLF_OK ? run_until(p, PUT) : result;
    result = result == RLF_OK ? rlf_synthetic_get_down(p->room.truth, &p->down) : result;
    if (result == RLF_OK && !find_pose(p, names[kind], &p->thing)) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: has no %s", source, names[kind]);
    }
    p->way = rlf_rotate(p->thing.q, rlf_vec3_make(rlf_cos(TURNED), 0, rlf_sin(TURNED)));
    return result == RLF_OK ? put_cube(p, kind) : result;
}

/* Where the cube is, seen from where the top of the plate is by now. */
static bool is_on(const push *p, const rlf_body_state *cube, rlf_vec3 plate)
{
    const rlf_vec3 off = rlf_sub(cube->T_world_body.p, plate);
    const double height = -rlf_dot(off, p->down) - HALF - 0.5 * SIZE;
    const rlf_vec3 aside = rlf_mad(off, p->down, -rlf_dot(off, p->down));
    return height > -0.03 && height < 0.03 && rlf_length(aside) < 0.1;
}

/* It rises with the plate, at its speed, until that stops. */
static rlf_result lift(push *p, bool *out_right)
{
    rlf_result result = run_until(p, START + RISE / p->speed - 1.0 / 30.0);
    const rlf_body_state *cube = cube_of(p);
    if (result == RLF_OK && cube != NULL) {
        const double risen = rlf_min(RISE, (p->room.frame.time_s - START) * p->speed);
        const double rising = -rlf_dot(cube->velocity, p->down) - p->speed;
        const double least = 0.1 * p->speed + 0.02;
        *out_right = is_on(p, cube, rlf_mad(p->thing.p, p->down, -risen)) && rising < least &&
                     rising > -least;
    }
    return result;
}

/* It is pushed along, and the board never passes it. */
static rlf_result swipe(push *p, bool *out_right)
{
    const rlf_vec3 face = rlf_rotate(p->thing.q, rlf_vec3_make(1, 0, 0));
    const rlf_vec3 along = rlf_rotate(p->thing.q, rlf_vec3_make(0, 0, 1));
    bool has_passed = false, was_before = true;
    double fastest = 0.0;
    rlf_result result = RLF_OK;
    while (result == RLF_OK && p->room.frame.time_s < START + WAY / p->speed) {
        result = eval_room_step(&p->room);
        const rlf_body_state *cube = cube_of(p);
        if (cube == NULL) {
            break;
        }
        const double way = rlf_clamp((p->room.frame.time_s - START) * p->speed, 0.0, WAY);
        const rlf_vec3 off = rlf_sub(cube->T_world_body.p, rlf_mad(p->thing.p, p->way, way));
        const double beside = rlf_dot(off, along);
        const bool is_before = rlf_dot(off, face) > 0.0;
        has_passed = has_passed || (was_before && !is_before && beside < 0.2 && beside > -0.2);
        was_before = is_before;
        fastest = rlf_max(fastest, rlf_dot(cube->velocity, p->way));
    }
    *out_right = !has_passed && fastest > 0.7 * p->speed;
    return result;
}

/* It goes round with the tray, for 3 s or one round. */
static rlf_result carry(push *p, bool *out_right)
{
    rlf_pose tray;
    rlf_result result = run_until(p, START + rlf_min(3.0, 2.0 * RLF_PI * CIRCLE / p->speed));
    const rlf_body_state *cube = cube_of(p);
    *out_right =
        result == RLF_OK && cube != NULL && find_pose(p, "tray", &tray) && is_on(p, cube, tray.p);
    return result;
}

static rlf_result run_one(int64_t seed, push_kind kind, double speed, bool *out_right)
{
    push p;
    *out_right = false;
    rlf_result result = open_push(seed, kind, speed, &p);
    if (result == RLF_OK) {
        result = kind == LIFT    ? lift(&p, out_right)
                 : kind == SWIPE ? swipe(&p, out_right)
                                 : carry(&p, out_right);
    }
    eval_room_close(&p.room);
    return result;
}

typedef struct push_name {
    const char *key, *title;
} push_name;

#define NAMES(kind, name, title)                                                                   \
    {                                                                                              \
        {kind "_01_percent", name ": " title " at 0.1 m/s, %"},                                    \
            {kind "_025_percent", name ": " title " at 0.25 m/s, %"},                              \
            {kind "_05_percent", name ": " title " at 0.5 m/s, %"},                                \
            {kind "_1_percent", name ": " title " at 1 m/s, %"},                                   \
        {                                                                                          \
            kind "_2_percent", name ": " title " at 2 m/s, %"                                      \
        }                                                                                          \
    }

static const push_name names[KINDS][SPEEDS] = {NAMES("lift", "LIFT", "rises with the plate"),
                                               NAMES("swipe", "SWIPE", "pushed, none passed"),
                                               NAMES("carry", "CARRY", "stays on the tray")};
static const push_name all_names[KINDS] = {{"lift_percent", "LIFT from rest: right, %"},
                                           {"swipe_percent", "SWIPE from rest: right, %"},
                                           {"carry_percent", "CARRY from rest: right, %"}};

/* Friction holds nothing on a tray that takes the circle at 1 m/s or more. */
static int32_t speeds_of(int32_t kind)
{
    return kind == CARRY ? 3 : SPEEDS;
}

rlf_result eval_random_add_pushes(eval_table *table, int64_t seed, bool has_all_speeds)
{
    const char *section = has_all_speeds ? EVAL_RANDOM_PUSH : EVAL_RANDOM;
    for (int32_t kind = 0; kind < KINDS; kind++) {
        const int32_t turn = (int32_t)(seed / 2) % speeds_of(kind);
        int32_t right = 0, count = 0;
        for (int32_t i = 0; i < speeds_of(kind); i++) {
            bool is_right = false;
            if (!has_all_speeds && i != turn) {
                continue;
            }
            rlf_result result = run_one(seed, (push_kind)kind, speeds[i], &is_right);
            if (result != RLF_OK) {
                return result;
            }
            right += is_right;
            count++;
            if (has_all_speeds) {
                eval_table_add(table, section, names[kind][i].key, names[kind][i].title,
                               RLF_PROFILE_LIVE, is_right ? 100.0 : 0.0);
            }
        }
        eval_table_add(table, section, all_names[kind].key, all_names[kind].title, RLF_PROFILE_LIVE,
                       eval_percent(right, count));
    }
    return RLF_OK;
}
