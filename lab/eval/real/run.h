/* `relief-lab eval --real DIR`: all parts. */
#ifndef RELIEF_APP_EVAL_REAL_RUN_H
#define RELIEF_APP_EVAL_REAL_RUN_H

#include "eval/real/real.h"

/* Measures everything that is there; what is not is said on stderr and has no rows. A missing
 * folder is not an error: it is skipped. */
rlf_result real_run(real_table *table, const real_options *options);

#endif
