/* Bodies on what the sensor shows: lifted, swept, carried, at rest, and left without support. */
#include "eval/sensed/hold.h"

#include "eval/ball.h"
#include "eval/sensed/room.h"
#include "eval/table.h"

#include <stdio.h>

#define SIZE 0.1       /* m, of all bodies */
#define TRAY_TOP 0.738 /* y of the lifting tray before it rises; it rises RISE from START on */
#define START 3.0
#define RISE 0.4
#define FRAME_S (1.0 / 30)
#define BOUNCE_SPEED 0.05 /* m/s; what meets the table slower does not bounce */
#define SETTLE_S 0.3      /* from the last bounce to rest */
#define LANDING_S 1.0     /* bounces later than this after the first touch are jitter */

static rlf_body_def body_of(rlf_shape_type type, rlf_vec3 position)
{
    static const rlf_vec3 corners[6] = {{0.05, 0, 0},  {-0.05, 0, 0}, {0, 0.05, 0},
                                        {0, -0.05, 0}, {0, 0, 0.05},  {0, 0, -0.05}};
    static const int32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                      2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    static const rlf_hull hull = {corners, 6, faces, 8};
    rlf_body_def def = rlf_body_def_default();
    def.shape =
        (rlf_shape){.type = type, .size = {SIZE, SIZE, SIZE}, .radius = 0.5 * SIZE, .hull = &hull};
    def.position = position;
    def.restitution = 0.2;
    def.angular_damping = 1.0; /* or a ball would roll off what is not quite level */
    return def;
}

/* Steps until `time`. */
static rlf_result run_until(eval_room *stage, double time)
{
    rlf_result result = RLF_OK;
    while (result == RLF_OK &&
           (stage->frame.surface == NULL || stage->frame.time_s < time - 1e-6)) {
        result = eval_room_step(stage);
    }
    return result;
}

static const rlf_body_state *first_of(const eval_room *stage)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(stage->world);
    return s->body_count > 0 ? &s->bodies[0] : NULL;
}

rlf_result eval_sensed_lift(rlf_profile profile, rlf_shape_type shape, double speed, bool *out_good,
                            double *out_error)
{
    char source[96];
    snprintf(source, sizeof(source), "synthetic:lift?color=0&frames=-1&speed=%g", speed);
    eval_room stage;
    rlf_result result = eval_room_open(source, 0, profile, 0, &stage);
    *out_good = false;
    *out_error = 1.0;
    if (result != RLF_OK) {
        return result;
    }
    result = run_until(&stage, 1.8);
    rlf_body_def def = body_of(shape, rlf_vec3_make(0, TRAY_TOP - 0.5 * SIZE - 0.01, 1.5));
    rlf_body_id id;
    result = result == RLF_OK ? rlf_world_add_body(stage.world, &def, &id) : result;
    double stop = START + RISE / speed;
    result = result == RLF_OK ? run_until(&stage, stop) : result;
    const rlf_body_state *body = first_of(&stage);
    if (result == RLF_OK && body != NULL) {
        double since = stage.frame.time_s - stop; /* in free flight by now */
        double leaving = -body->velocity.y + 9.81 * since;
        double fallen = leaving * since - 0.5 * 9.81 * since * since;
        double off = body->T_world_body.p.y + fallen - (TRAY_TOP - RISE - 0.5 * SIZE);
        *out_error = rlf_max(leaving / speed - 1.0, 1.0 - leaving / speed);
        *out_good = *out_error <= 0.1 && off < 0.03 && off > -0.03;
    }
    eval_room_close(&stage);
    return result;
}

rlf_result eval_sensed_swipe(rlf_profile profile, rlf_shape_type shape, double speed,
                             bool *out_good)
{
    char source[96];
    snprintf(source, sizeof(source), "synthetic:swipe?color=0&frames=-1&speed=%g", speed);
    eval_room stage;
    rlf_result result = eval_room_open(source, 0, profile, 0, &stage);
    *out_good = false;
    if (result != RLF_OK) {
        return result;
    }
    result = run_until(&stage, 1.8);
    rlf_body_def def = body_of(shape, rlf_vec3_make(0, 1.3 - 0.5 * SIZE - 0.01, 2.8));
    rlf_body_id id;
    result = result == RLF_OK ? rlf_world_add_body(stage.world, &def, &id) : result;
    bool has_passed = false, was_before = true;
    double fastest = 0.0;
    const rlf_vec3 face = {rlf_cos(0.35), 0, -rlf_sin(0.35)};
    const rlf_vec3 along = {-face.z, 0, face.x};
    while (result == RLF_OK && stage.frame.time_s < START + 1.1 / speed) {
        result = eval_room_step(&stage);
        const rlf_body_state *body = first_of(&stage);
        if (body == NULL) {
            break;
        }
        double way = rlf_clamp((stage.frame.time_s - START) * speed, 0.0, 1.1);
        rlf_vec3 d = rlf_sub(body->T_world_body.p, rlf_vec3_make(-0.6 + way, 1.04, 2.8));
        double beside = rlf_dot(d, along);
        bool is_before = rlf_dot(d, face) > 0.0;
        has_passed = has_passed || (was_before && !is_before && beside < 0.2 && beside > -0.2);
        was_before = is_before;
        fastest = rlf_max(fastest, body->velocity.x);
    }
    *out_good = !has_passed && fastest > 0.7 * speed;
    eval_room_close(&stage);
    return result;
}

rlf_result eval_sensed_carry(rlf_profile profile, int32_t *out_stayed)
{
    eval_room stage;
    rlf_result result =
        eval_room_open("synthetic:carry?color=0&frames=-1&speed=0.5", 0, profile, 0, &stage);
    *out_stayed = 0;
    if (result != RLF_OK) {
        return result;
    }
    result = run_until(&stage, 1.8);
    for (int32_t i = 0; i < 3 && result == RLF_OK; i++) {
        rlf_body_def def = body_of(RLF_SHAPE_BOX, rlf_vec3_make(0, 0.53 - 0.102 * i, 1.6));
        rlf_body_id id;
        result = rlf_world_add_body(stage.world, &def, &id);
    }
    result = result == RLF_OK ? run_until(&stage, 9.0) : result;
    const rlf_snapshot *s = rlf_world_get_snapshot(stage.world);
    for (int32_t i = 0; i < s->body_count && result == RLF_OK; i++) {
        rlf_synthetic_hit hit; /* each stands i cubes above the tray */
        result = rlf_synthetic_nearest(stage.truth, stage.frame.time_s, s->bodies[i].T_world_body.p,
                                       &hit);
        double off = hit.distance - SIZE * (i + 0.5);
        *out_stayed += hit.label == RLF_SYNTHETIC_LABEL_TRAY && off < 0.02 && off > -0.02;
    }
    eval_room_close(&stage);
    return result;
}

/* Where a body is over time, about its first place. */
typedef struct rest_sum {
    rlf_vec3 origin, sum;
    double square;
    int64_t count;
} rest_sum;

static void add_place(rest_sum *sum, rlf_vec3 p)
{
    sum->origin = sum->count == 0 ? p : sum->origin;
    rlf_vec3 d = rlf_sub(p, sum->origin);
    sum->sum = rlf_add(sum->sum, d);
    sum->square += rlf_dot(d, d);
    sum->count++;
}

static double spread_mm(const rest_sum *sum)
{
    double n = (double)sum->count;
    rlf_vec3 mean = rlf_scale(sum->sum, 1.0 / n);
    return n > 0.0 ? 1e3 * sqrt(rlf_max(0.0, sum->square / n - rlf_dot(mean, mean))) : NAN;
}

/* A cube that comes down, as seen so far. */
typedef struct landing {
    double touched, bounced; /* s of its first touch and of its last bounce; < 0: none yet */
    bool was_asleep;
    rest_sum all, awake; /* places from rest on */
} landing;

static bool is_bounce(const rlf_snapshot *s)
{
    bool is_hard = false;
    for (int32_t i = 0; i < s->contact_count; i++) {
        is_hard = is_hard || s->contacts[i].approach_speed > BOUNCE_SPEED;
    }
    return is_hard;
}

static void watch(landing *l, const rlf_snapshot *s, double now, eval_rest *out)
{
    const rlf_body_state *body = &s->bodies[0];
    bool is_first = l->touched < 0.0 && s->contact_count > 0;
    l->touched = is_first ? now : l->touched;
    bool is_landing = is_first || (is_bounce(s) && now < l->touched + LANDING_S);
    l->bounced = is_landing ? now : l->bounced;
    if (l->touched >= 0.0 && now > l->bounced + SETTLE_S) {
        add_place(&l->all, body->T_world_body.p);
        if (!body->is_asleep) {
            add_place(&l->awake, body->T_world_body.p);
        }
    }
    out->asleep_s = body->is_asleep ? rlf_min(out->asleep_s, now - l->touched) : out->asleep_s;
    out->wakes += l->was_asleep && !body->is_asleep;
    l->was_asleep = body->is_asleep;
}

rlf_result eval_sensed_rest(rlf_profile profile, double seconds, eval_rest *out)
{
    eval_room stage;
    rlf_result result = eval_room_open("synthetic:empty?color=0&frames=-1", 0, profile, 0, &stage);
    *out = (eval_rest){.asleep_s = EVAL_NEVER};
    if (result != RLF_OK) {
        return result;
    }
    result = run_until(&stage, 1.0);
    rlf_body_def def = body_of(RLF_SHAPE_BOX, rlf_vec3_make(1.04, 0.565 - 0.06, 2.22));
    rlf_body_id id;
    result = result == RLF_OK ? rlf_world_add_body(stage.world, &def, &id) : result;
    landing l = {.touched = -1.0, .bounced = -1.0};
    while (result == RLF_OK && stage.frame.time_s < 1.0 + seconds) {
        result = eval_room_step(&stage);
        if (result != RLF_OK || first_of(&stage) == NULL) {
            break;
        }
        watch(&l, stage.frame.snapshot, stage.frame.time_s, out);
    }
    out->jitter_mm = spread_mm(&l.all);
    out->awake_mm = spread_mm(&l.awake);
    eval_room_close(&stage);
    return result;
}

rlf_result eval_sensed_chair(rlf_profile profile, double *out_frames)
{
    const double REMOVED = 4.0;
    eval_room stage;
    rlf_result result = eval_room_open("synthetic:chair?color=0&frames=-1", 0, profile, 0, &stage);
    *out_frames = EVAL_NEVER;
    if (result != RLF_OK) {
        return result;
    }
    result = run_until(&stage, 2.0);
    rlf_body_def def = body_of(RLF_SHAPE_BOX, rlf_vec3_make(-1.12, 0.835 - 0.055, 3.38));
    rlf_body_id id;
    result = result == RLF_OK ? rlf_world_add_body(stage.world, &def, &id) : result;
    result = result == RLF_OK ? run_until(&stage, REMOVED - FRAME_S) : result;
    double y =
        result == RLF_OK && first_of(&stage) != NULL ? first_of(&stage)->T_world_body.p.y : 9.0;
    for (int32_t i = 0; i < 60 && result == RLF_OK && *out_frames > 60.0; i++) {
        result = eval_room_step(&stage);
        const rlf_body_state *body = first_of(&stage);
        bool is_on_seat = y > 0.75 && y < 0.80;
        if (body != NULL && is_on_seat && body->T_world_body.p.y > y + 0.002) {
            *out_frames = i; /* 0: in the very frame that shows it gone */
        }
    }
    eval_room_close(&stage);
    return result;
}
