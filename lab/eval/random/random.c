/* One room drawn at random: throws and pushes. */
#include "eval/random/random.h"

#include "eval/measures/percent.h"
#include "eval/sensed/throw.h"
#include "eval/table.h"

#include <stdio.h>

#define THROWS 60
#define BEGIN_S 2.0 /* people are in view */
#define END_S 7.0

#define ADD(key, title, value)                                                                     \
    eval_table_add(table, EVAL_RANDOM, key, title, RLF_PROFILE_LIVE, value)

static rlf_result throw_things(int64_t seed, eval_aim aim, eval_throws *out)
{
    char source[96];
    snprintf(source, sizeof(source), "synthetic:random?color=0&frames=-1&seed=%lld",
             (long long)seed);
    const eval_throw_def def = {.source = source,
                                .aim = aim,
                                .throws = THROWS,
                                .per_frame = 2,
                                .begin_s = aim == EVAL_AIM_ROOM ? 0.0 : BEGIN_S,
                                .end_s = END_S,
                                .profile = RLF_PROFILE_LIVE,
                                .seed = (uint64_t)seed};
    return eval_sensed_throw(&def, out);
}

static rlf_result add_throws(eval_table *table, int64_t seed)
{
    eval_throws still, back, side;
    rlf_result result = throw_things(seed, EVAL_AIM_ROOM, &still);
    result = result == RLF_OK ? throw_things(seed, EVAL_AIM_BACK, &back) : result;
    result = result == RLF_OK ? throw_things(seed, EVAL_AIM_SIDE, &side) : result;
    if (result == RLF_OK) {
        ADD("throw_tunnelled_percent", "THROW: tunnelled, %",
            eval_percent(still.tunnelled + still.not_finite, still.thrown));
        ADD("throw_swallowed_percent", "THROW: deep in what moves, %",
            eval_percent(still.swallowed, still.thrown));
        ADD("behind_passed_percent", "BEHIND: through a person's back, %",
            eval_percent(back.passed, back.thrown));
        ADD("behind_bounced_percent", "BEHIND: bounced off it, %",
            eval_percent(back.bounced, back.thrown));
        ADD("edge_passed_percent", "EDGE: through a person from the side, %",
            eval_percent(side.passed, side.thrown));
        ADD("edge_bounced_percent", "EDGE: bounced off him, %",
            eval_percent(side.bounced, side.thrown));
    }
    return result;
}

rlf_result eval_random_run(eval_table *table, int64_t seed)
{
    rlf_result result = add_throws(table, seed);
    return result == RLF_OK ? eval_random_add_pushes(table, seed, false) : result;
}

rlf_result eval_random_push_run(eval_table *table, int64_t seed)
{
    return eval_random_add_pushes(table, seed, true);
}
