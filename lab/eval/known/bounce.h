/* Bodies thrown at known things. */
#ifndef RELIEF_APP_EVAL_KNOWN_BOUNCE_H
#define RELIEF_APP_EVAL_KNOWN_BOUNCE_H

#include "eval/known/room.h"
#include "eval/table.h"

/* Bodies thrown at the boxes from all around. */
rlf_result known_run_bounce(eval_table *table, int64_t seed,
                            const rlf_known_def models[KNOWN_MODELS]);

#endif
