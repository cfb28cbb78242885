/* Bodies behind known things. */
#ifndef RELIEF_APP_EVAL_KNOWN_PICTURE_H
#define RELIEF_APP_EVAL_KNOWN_PICTURE_H

#include "eval/known/room.h"
#include "eval/table.h"

/* Bodies behind the boxes, with and without models. */
rlf_result known_run_picture(eval_table *table, int64_t seed,
                             const rlf_known_def models[KNOWN_MODELS]);

#endif
