/* Light on the bodies of pictures, against the truth. */
#ifndef RELIEF_APP_EVAL_PICTURE_LIGHT_H
#define RELIEF_APP_EVAL_PICTURE_LIGHT_H

#include "eval/table.h"

/* Adds rows of profile live to the section "picture". */
rlf_result picture_light_run(eval_table *table, int64_t seed);

#endif
