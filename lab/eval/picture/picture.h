/* How well bodies are hidden in the picture, against the truth at the colour camera. */
#ifndef RELIEF_APP_EVAL_PICTURE_PICTURE_H
#define RELIEF_APP_EVAL_PICTURE_PICTURE_H

#include "eval/table.h"

/* A few pictures of one seed: soft occlusion for profile live, the thesis's layers for profile
 * thesis. */
rlf_result eval_picture_run(eval_table *table, int64_t seed, int profile_mask);
/* Every picture of that many frames, and hard occlusion too; `oracle` says what is true, bits of
 * eval_oracle_part. */
rlf_result eval_picture_run_whole(eval_table *table, int64_t seed, int64_t frames, int32_t oracle,
                                  int profile_mask);

#endif
