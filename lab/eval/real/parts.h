/* What is measured on real recordings, part by part. */
#ifndef RELIEF_APP_EVAL_REAL_PARTS_H
#define RELIEF_APP_EVAL_REAL_PARTS_H

#include "eval/real/real.h"

/* Each says on stderr what it is at. */
rlf_result real_still_run(real_table *table, const real_options *options);
rlf_result real_silhouettes_run(real_table *table, const real_options *options);
rlf_result real_moving_run(real_table *table, const real_options *options);
rlf_result real_standing_run(real_table *table, const real_options *options);

#endif
