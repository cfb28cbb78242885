/* Sections "hands" and "gestures" of `relief-lab eval`. */
#include "eval/hands/hands.h"
#include "eval/sections.h"

rlf_result eval_hands_run(eval_table *table, int64_t seed, int profile_mask)
{
    if (!(profile_mask & (1 << RLF_PROFILE_LIVE))) {
        return RLF_OK;
    }
    rlf_result result = hands_grasp_run(table, seed);
    return result == RLF_OK ? hands_pass_run(table, seed) : result;
}

rlf_result eval_gestures_run(eval_table *table, int64_t seed, int profile_mask)
{
    if (!(profile_mask & (1 << RLF_PROFILE_LIVE))) {
        return RLF_OK;
    }
    const rlf_result result = hands_judge_run(table, seed);
    return result == RLF_OK ? hands_track_run(table, seed) : result;
}

rlf_result eval_grasps_run(eval_table *table, int64_t seed, int profile_mask)
{
    return profile_mask & (1 << RLF_PROFILE_LIVE) ? hands_others_run(table, seed) : RLF_OK;
}
