/* Grasps: is the body lifted, carried half a metre aside, and let go where the hand opens? How far
 * does it slip meanwhile, and does it fly as the hand threw it? */
#include "eval/hands/hands.h"
#include "eval/measures/percent.h"

#define GRASPS 6
#define RISEN 0.7    /* of the hand's rise */
#define HELD 0.04    /* metres from its place in the hand: it is carried */
#define DROPPED 0.05 /* metres under the place where the hand opened ... */
#define ASIDE 0.08   /* ... and so far aside at most */
#define LET_GO_S 0.6 /* s after the hand opens */
#define STILL_S 10.0
#define FLIGHT_S 0.2 /* s after a throw: the fingers are open */

typedef struct grasp_result {
    bool is_lifted, is_carried, is_let_go;
    double slip, slip_still; /* metres */
} grasp_result;

static const struct {
    const char *key, *title;
} rows[GRASPS] = {{"pinch_above_percent", "  pinch from above, %"},
                  {"pinch_side_percent", "  pinch from the side, %"},
                  {"fist_bar_percent", "  a fist around a bar, %"},
                  {"two_hands_percent", "  two hands at its sides, %"},
                  {"scoop_percent", "  in the hollow of the hand, %"},
                  {"under_percent", "  on the flat hand, %"}};

static rlf_vec3 body_at(const hands_run *run)
{
    const rlf_snapshot *s = run->frame.snapshot;
    return s->body_count > 0 ? s->bodies[0].T_world_body.p : rlf_vec3_make(0, 0, 1e3);
}

static rlf_result carry(hands_run *run, grasp_result *out)
{
    const rlf_synthetic_task *task = &run->task;
    rlf_result result = hands_step_until(run, task->closed + 0.15);
    rlf_vec3 start = body_at(run), held = hands_body_in_hand(run);
    result = result == RLF_OK ? hands_step_until(run, task->lifted) : result;
    double risen = rlf_dot(rlf_sub(start, body_at(run)), run->down);
    rlf_vec3 lifted = hands_body_in_hand(run);
    result = result == RLF_OK ? hands_step_until(run, task->carried) : result;
    rlf_vec3 carried = hands_body_in_hand(run);
    result = result == RLF_OK ? hands_step_until(run, task->opened) : result;
    rlf_vec3 still = hands_body_in_hand(run);
    out->is_lifted = risen > RISEN * task->rise;
    out->is_carried = out->is_lifted && rlf_length(rlf_sub(still, held)) < HELD;
    out->slip = out->is_carried ? rlf_length(rlf_sub(carried, lifted)) : NAN;
    out->slip_still = out->is_carried ? rlf_length(rlf_sub(still, carried)) : NAN;
    return result;
}

static rlf_result grasp(const rlf_synthetic_def *def, grasp_result *out)
{
    hands_run run;
    rlf_result result = hands_open(def, &run);
    if (result != RLF_OK) {
        return result;
    }
    result = carry(&run, out);
    rlf_vec3 opened = body_at(&run);
    result = result == RLF_OK ? hands_step_until(&run, run.task.opened + LET_GO_S) : result;
    rlf_vec3 way = rlf_sub(body_at(&run), opened);
    double fall = rlf_dot(way, run.down);
    double aside = rlf_length(rlf_mad(way, run.down, -fall));
    bool is_turned = def->hands.act == RLF_SYNTHETIC_ACT_SCOOP ||
                     def->hands.act == RLF_SYNTHETIC_ACT_UNDER; /* it slides off aside */
    out->is_let_go = out->is_carried && fall > DROPPED && aside < (is_turned ? 3.0 : 1.0) * ASIDE;
    hands_close(&run);
    return result;
}

static void add(eval_table *table, const char *key, const char *title, double value)
{
    eval_table_add(table, HANDS_SECTION, key, title, RLF_PROFILE_LIVE, value);
}

static rlf_result still_run(eval_table *table, int64_t seed)
{
    static const rlf_synthetic_act acts[3] = {
        RLF_SYNTHETIC_ACT_PINCH_ABOVE, RLF_SYNTHETIC_ACT_PINCH_SIDE, RLF_SYNTHETIC_ACT_TWO_HANDS};
    eval_random r = eval_random_start((uint64_t)(seed * 1000 + 900));
    rlf_synthetic_def def = hands_draw(acts[seed % 3], &r, (uint64_t)(seed * 100 + 90));
    grasp_result g = {.slip = NAN, .slip_still = NAN};
    def.speed = 0.5;
    def.hands.hold = STILL_S;
    rlf_result result = grasp(&def, &g);
    add(table, "slip_still_mm", "slip in a hand that is still for 10 s, mm", 1e3 * g.slip_still);
    return result;
}

static double angle_deg(rlf_vec3 a, rlf_vec3 b)
{
    double cosine = rlf_dot(rlf_normalize(a), rlf_normalize(b));
    return rlf_acos(rlf_clamp(cosine, -1.0, 1.0)) * 180.0 / RLF_PI;
}

/* Off the hand at some time while it opened, the body has only fallen since: what it fell is taken
 * out as far as that can be. */
static rlf_vec3 thrown_velocity(const hands_run *run, double g)
{
    rlf_vec3 v = run->frame.snapshot->bodies[0].velocity;
    double extra = rlf_dot(rlf_sub(v, run->task.thrown), run->down);
    double since = run->frame.time_s - run->task.opened;
    return rlf_mad(v, run->down, -rlf_clamp(extra, 0.0, g * since));
}

static rlf_result throw_run(eval_table *table, int64_t seed)
{
    eval_random r = eval_random_start((uint64_t)(seed * 1000 + 800));
    rlf_synthetic_def def = hands_draw(RLF_SYNTHETIC_ACT_THROW, &r, (uint64_t)(seed * 100 + 80));
    hands_run run;
    rlf_result result = hands_open(&def, &run);
    if (result != RLF_OK) {
        return result;
    }
    result = hands_step_until(&run, run.task.closed + 0.15);
    rlf_vec3 held = hands_body_in_hand(&run);
    result = result == RLF_OK ? hands_step_until(&run, run.task.opened) : result;
    bool is_held = rlf_length(rlf_sub(hands_body_in_hand(&run), held)) < HELD;
    result = result == RLF_OK ? hands_step_until(&run, run.task.opened + FLIGHT_S) : result;
    is_held = is_held && result == RLF_OK && run.frame.snapshot->body_count > 0;
    double speed = NAN, turn = NAN;
    if (is_held) {
        rlf_vec3 v = thrown_velocity(&run, 9.81);
        double want = rlf_length(run.task.thrown), error = rlf_length(v) / want - 1.0;
        speed = 100.0 * (error < 0.0 ? -error : error);
        turn = angle_deg(v, run.task.thrown);
    }
    add(table, "throw_held_percent", "thrown: still held as the hand opens, %",
        is_held ? 100.0 : 0.0);
    add(table, "throw_speed_percent", "  error of its speed, %", speed);
    add(table, "throw_direction_deg", "  error of its direction, degrees", turn);
    hands_close(&run);
    return result;
}

static void report(eval_table *table, const grasp_result *g)
{
    int64_t lifted = 0, carried = 0, let_go = 0;
    double slip = 0.0;
    for (int i = 0; i < GRASPS; i++) {
        lifted += g[i].is_lifted;
        carried += g[i].is_carried;
        let_go += g[i].is_let_go;
        slip += g[i].is_carried ? g[i].slip : 0.0;
    }
    add(table, "grasps_percent", "grasps: lifted, carried 0.5 m and let go where it opens, %",
        eval_percent(let_go, GRASPS));
    for (int i = 0; i < GRASPS; i++) {
        add(table, rows[i].key, rows[i].title, g[i].is_let_go ? 100.0 : 0.0);
    }
    add(table, "lifted_percent", "  of all: lifted, %", eval_percent(lifted, GRASPS));
    add(table, "carried_percent", "  and carried, %", eval_percent(carried, GRASPS));
    add(table, "slip_carried_mm", "slip while carried 0.5 m, mm",
        carried > 0 ? 1e3 * slip / (double)carried : NAN);
}

rlf_result hands_grasp_run(eval_table *table, int64_t seed)
{
    grasp_result g[GRASPS] = {{.slip = NAN}};
    rlf_result result = RLF_OK;
    for (int i = 0; i < GRASPS && result == RLF_OK; i++) {
        eval_random r = eval_random_start((uint64_t)(seed * 1000 + i));
        rlf_synthetic_def def = hands_draw((rlf_synthetic_act)i, &r, (uint64_t)(seed * 100 + i));
        result = grasp(&def, &g[i]);
    }
    if (result == RLF_OK) {
        report(table, g);
        result = still_run(table, seed);
    }
    return result == RLF_OK ? throw_run(table, seed) : result;
}
