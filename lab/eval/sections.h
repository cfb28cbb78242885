/* The parts of `relief-lab eval` beside the synthetic scenes; each adds its rows to the table. */
#ifndef RELIEF_APP_EVAL_SECTIONS_H
#define RELIEF_APP_EVAL_SECTIONS_H

#include "eval/table.h"

/* The simulated sensor itself: its missing points beside table 5.1 of the thesis. */
rlf_result eval_simulator_run(eval_table *table, int64_t seed, int profile_mask);
/* Noise-free planes of any slope over the whole field of view, and a plane with holes. */
rlf_result eval_planes_run(eval_table *table, int64_t seed, int profile_mask);
/* A plate that moves at 0.5 m/s before a wall, seen with noise. */
rlf_result eval_plate_run(eval_table *table, int64_t seed, int profile_mask);
/* Clean depth with true normals: every frame below `folder`; see lab/measuring.md. */
rlf_result eval_public_run(eval_table *table, const char *folder, int profile_mask);
/* Things that stood from the first frame on start to move under and beside bodies. */
rlf_result eval_start_run(eval_table *table, int64_t seed, int profile_mask);
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
/* What tracking and fusing a frame costs, and the memory of a room of 5 x 5 x 3 m. */
rlf_result eval_map_cost_run(eval_table *table, int64_t seed, int profile_mask);
/* Poses of a camera that moves, found against the map. */
rlf_result eval_moving_run(eval_table *table, int64_t seed, int profile_mask);
/* Cameras that stand, and cameras that are moved and put down. */
rlf_result eval_standing_run(eval_table *table, int64_t seed, int profile_mask);
/* What is remembered of the room behind people: per pixel, and by a map. */
rlf_result eval_memory_run(eval_table *table, int64_t seed, int profile_mask);
/* Scripted hands of the simulator: grasps, throws, false grabs. */
rlf_result eval_hands_run(eval_table *table, int64_t seed, int profile_mask);
rlf_result eval_gestures_run(eval_table *table, int64_t seed, int profile_mask);

#endif
