/* The parts of `relief-lab eval` beside the synthetic scenes; each adds its rows to the table. */
#ifndef RELIEF_APP_EVAL_SECTIONS_H
#define RELIEF_APP_EVAL_SECTIONS_H

#include "eval/table.h"

/* Free flight, collisions between bodies, and bodies on sensed planes that move or rest. */
rlf_result eval_physics_run(eval_table *table, int64_t seed, int profile_mask);
/* Physics on what the synthetic sensor shows, against the true scene. */
rlf_result eval_sensed_run(eval_table *table, int64_t seed, int profile_mask);
/* Its throws in profile live, with parts of the surface true: bits of eval_oracle_part. */
rlf_result eval_sensed_run_oracle(eval_table *table, int64_t seed, int32_t oracle);
/* Models of known real things in the synthetic room. */
rlf_result eval_known_run(eval_table *table, int64_t seed, int profile_mask);
/* A moving camera's map of the synthetic room against the true one; poses are true. */
rlf_result eval_map_run(eval_table *table, int64_t seed, int profile_mask);
/* Poses of a camera that moves, found against the map. */
rlf_result eval_moving_run(eval_table *table, int64_t seed, int profile_mask);
/* Cameras that stand, and cameras that are moved and put down. */
rlf_result eval_standing_run(eval_table *table, int64_t seed, int profile_mask);
/* Scripted hands of the simulator: grasps, throws, false grabs. */
rlf_result eval_hands_run(eval_table *table, int64_t seed, int profile_mask);
rlf_result eval_gestures_run(eval_table *table, int64_t seed, int profile_mask);
rlf_result eval_grasps_run(eval_table *table, int64_t seed, int profile_mask);

#endif
