/* The rows of section "sensed". */
#include "eval/measures/percent.h"
#include "eval/sections.h"
#include "eval/sensed/hold.h"
#include "eval/sensed/throw.h"
#include "eval/table.h"

#define THROWS 334     /* per seed and row: 3 seeds make 1000 */
#define BALLS 400      /* of REALISM, per seed */
#define LOST_MAX 10    /* frames lost in a row */
#define LOST_THROWS 20 /* per number of lost frames */
#define LOST_BEGIN 1.5 /* s; the person walks in the middle of the view */

#define ADD(key, title, value) eval_table_add(table, "sensed", key, title, profile, value)

typedef struct throw_conditions {
    rlf_profile profile;
    int32_t oracle;
    uint64_t seed;
} throw_conditions;

static rlf_result add_static_throws(eval_table *table, const throw_conditions *on)
{
    const rlf_profile profile = on->profile;
    eval_throw_def def = {.source = "synthetic:empty?color=0&frames=-1",
                          .throws = THROWS,
                          .profile = profile,
                          .oracle = on->oracle,
                          .seed = on->seed};
    eval_throws o;
    rlf_result result = eval_sensed_throw(&def, &o);
    if (result == RLF_OK) {
        ADD("throw_tunnelled", "THROW: tunnelled, of 334 throws into the still room",
            (double)o.tunnelled);
        ADD("throw_not_finite", "THROW: not finite", (double)o.not_finite);
    }
    return result;
}

/* Each of 1 to LOST_MAX frames lost after every one that arrives, while a person walks or not. */
static rlf_result throw_through_gaps(const throw_conditions *on, bool is_walking, eval_throws *sum)
{
    const char *still = "synthetic:empty?color=0&frames=-1";
    const char *walked = "synthetic:room?color=0&frames=-1";
    rlf_result result = RLF_OK;
    *sum = (eval_throws){0};
    for (int32_t lost = 1; lost <= LOST_MAX && result == RLF_OK; lost++) {
        eval_throw_def def = {.source = is_walking ? walked : still,
                              .aim = is_walking ? EVAL_AIM_ANY : EVAL_AIM_ROOM,
                              .throws = LOST_THROWS,
                              .per_frame = 2,
                              .begin_s = is_walking ? LOST_BEGIN : 0.0,
                              .lost = lost,
                              .profile = on->profile,
                              .oracle = on->oracle,
                              .seed = on->seed};
        eval_throws o;
        result = eval_sensed_throw(&def, &o);
        sum->tunnelled += o.tunnelled;
        sum->swallowed += o.swallowed;
        sum->not_finite += o.not_finite;
        sum->fastest = rlf_max(sum->fastest, o.fastest);
    }
    return result;
}

static rlf_result add_lost_frames(eval_table *table, const throw_conditions *on)
{
    const rlf_profile profile = on->profile;
    eval_throws o;
    rlf_result result = throw_through_gaps(on, false, &o);
    if (result == RLF_OK) {
        ADD("drop_tunnelled", "DROP-FRAMES, 1 to 10 lost: tunnelled, of 200",
            (double)(o.tunnelled + o.not_finite));
        ADD("drop_fastest", "DROP-FRAMES: fastest body, m/s (thrown at up to 10)", o.fastest);
        result = throw_through_gaps(on, true, &o);
    }
    if (result == RLF_OK) {
        ADD("drop_walk_tunnelled", "DROP-FRAMES, a person walks: tunnelled, of 200",
            (double)o.tunnelled);
        ADD("drop_walk_swallowed", "DROP-FRAMES, a person walks: deep in the person, of 200",
            (double)o.swallowed);
        ADD("drop_walk_not_finite", "DROP-FRAMES, a person walks: not finite",
            (double)o.not_finite);
        ADD("drop_walk_fastest", "DROP-FRAMES, a person walks: fastest body, m/s", o.fastest);
    }
    return result;
}

static rlf_result add_aimed(eval_table *table, const throw_conditions *on, bool is_edge)
{
    const rlf_profile profile = on->profile;
    eval_throw_def def = {.source = is_edge ? "synthetic:book?color=0&frames=-1"
                                            : "synthetic:room?frames=-1",
                          .aim = is_edge ? EVAL_AIM_EDGE : EVAL_AIM_BEHIND,
                          .throws = THROWS,
                          .profile = profile,
                          .oracle = on->oracle,
                          .seed = on->seed};
    eval_throws o;
    rlf_result result = eval_sensed_throw(&def, &o);
    if (result == RLF_OK && is_edge) {
        ADD("edge_bounced_percent", "EDGE: bounced off a book's edge, %",
            eval_percent(o.bounced, o.thrown));
        ADD("edge_passed_percent", "EDGE: went through, %", eval_percent(o.passed, o.thrown));
    } else if (result == RLF_OK) {
        ADD("behind_bounced_percent", "BEHIND: bounced off a person's back, %",
            eval_percent(o.bounced, o.thrown));
        ADD("behind_passed_percent", "BEHIND: went through, %", eval_percent(o.passed, o.thrown));
    }
    return result;
}

static rlf_result add_realism(eval_table *table, const throw_conditions *on)
{
    const rlf_profile profile = on->profile;
    eval_throw_def def = {.source = "synthetic:room?frames=-1",
                          .aim = EVAL_AIM_ANY,
                          .throws = BALLS,
                          .balls_only = true,
                          .profile = profile,
                          .oracle = on->oracle,
                          .seed = on->seed};
    eval_throws o;
    rlf_result result = eval_sensed_throw(&def, &o);
    if (result == RLF_OK) {
        ADD("realism_percent", "REALISM: bounces within 10 deg of a true one, %",
            eval_percent(o.right_nearby, o.bounces));
        ADD("realism_exact_percent", "  of the true one of that very throw, %",
            eval_percent(o.right, o.bounces));
        ADD("realism_conditioned_percent", "  ... of those that 2 mm do not change by 10 deg, %",
            eval_percent(o.conditioned_right, o.conditioned));
        ADD("realism_ill_percent", "  bounces that 2 mm change by more than 10 deg, %",
            eval_percent(o.bounces - o.conditioned, o.bounces));
        ADD("realism_phantom_percent", "REALISM: off nothing, %",
            eval_percent(o.phantom, o.bounces));
        ADD("realism_missed_percent", "REALISM: none where truth has one, %",
            eval_percent(o.missed, o.bounces));
        ADD("realism_hidden_percent", "  off what the camera cannot see: within 10 deg, %",
            eval_percent(o.hidden_right, o.hidden));
    }
    return result;
}

/* Three shapes at four speeds. */
static rlf_result add_pushes(eval_table *table, rlf_profile profile)
{
    const rlf_shape_type shapes[3] = {RLF_SHAPE_BOX, RLF_SHAPE_SPHERE, RLF_SHAPE_HULL};
    const double speeds[4] = {0.25, 0.5, 1.0, 2.0};
    double lifted = 0.0, swept = 0.0, worst = 0.0;
    rlf_result result = RLF_OK;
    for (int i = 0; i < 12 && result == RLF_OK; i++) {
        bool is_lifted = false, is_swept = false;
        double error = 0.0;
        result = eval_sensed_lift(profile, shapes[i / 4], speeds[i % 4], &is_lifted, &error);
        if (result == RLF_OK) {
            result = eval_sensed_swipe(profile, shapes[i / 4], speeds[i % 4], &is_swept);
        }
        lifted += is_lifted;
        swept += is_swept;
        worst = rlf_max(worst, error);
    }
    ADD("lift_count", "LIFT: carried by a tray and thrown, of 12", lifted);
    ADD("lift_error_percent", "LIFT: leaving speed, worst error, %", 100.0 * worst);
    ADD("swipe_count", "SWIPE: pushed by a board, none passed, of 12", swept);
    return result;
}

static rlf_result add_rest(eval_table *table, rlf_profile profile)
{
    int32_t stayed = 0;
    eval_rest rest;
    double frames = 0.0;
    rlf_result result = eval_sensed_carry(profile, &stayed);
    ADD("carry_stayed", "CARRY: cubes that stay on a tray at 0.5 m/s, of 3", stayed);
    result = result == RLF_OK ? eval_sensed_rest(profile, 60.0, &rest) : result;
    if (result == RLF_OK) {
        ADD("noise_jitter_mm", "NOISE: cube on a table for 60 s, RMS, mm", rest.jitter_mm);
        ADD("noise_awake_mm", "NOISE: the same until it sleeps, mm", rest.awake_mm);
        ADD("noise_asleep_s", "NOISE: asleep after, s", rest.asleep_s);
        ADD("noise_wakes", "NOISE: wakes", rest.asleep_s < EVAL_NEVER ? rest.wakes : NAN);
        result = eval_sensed_chair(profile, &frames);
    }
    if (result == RLF_OK) {
        ADD("chair_frames", "CHAIR: frames until what stood on it falls", frames);
    }
    return result;
}

static rlf_result add_throws(eval_table *table, const throw_conditions *on)
{
    rlf_result result = add_static_throws(table, on);
    result = result == RLF_OK ? add_lost_frames(table, on) : result;
    result = result == RLF_OK ? add_aimed(table, on, false) : result;
    result = result == RLF_OK ? add_aimed(table, on, true) : result;
    return result == RLF_OK ? add_realism(table, on) : result;
}

rlf_result eval_sensed_run(eval_table *table, int64_t seed, int profile_mask)
{
    rlf_result result = RLF_OK;
    for (int i = 0; i < EVAL_PROFILES && result == RLF_OK; i++) {
        const throw_conditions on = {.profile = (rlf_profile)i, .seed = (uint64_t)seed};
        if (!(profile_mask & (1 << i))) {
            continue;
        }
        result = seed == 1 ? add_pushes(table, on.profile) : RLF_OK;
        result = result == RLF_OK && seed == 1 ? add_rest(table, on.profile) : result;
        result = result == RLF_OK ? add_throws(table, &on) : result;
    }
    return result;
}

rlf_result eval_sensed_run_oracle(eval_table *table, int64_t seed, int32_t oracle)
{
    const throw_conditions on = {
        .profile = RLF_PROFILE_LIVE, .oracle = oracle, .seed = (uint64_t)seed};
    return add_throws(table, &on);
}
