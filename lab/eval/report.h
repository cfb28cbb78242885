/* Tables and JSON of what `relief-lab eval` has measured. */
#ifndef RELIEF_APP_EVAL_REPORT_H
#define RELIEF_APP_EVAL_REPORT_H

#include "eval/bounds.h"
#include "eval/real/real.h"
#include "eval/table.h"

typedef struct eval_report_options {
    bool print_all;        /* every figure; else those with a goal or a bound */
    bool is_whole;         /* nothing was shortened: a bounded figure without samples is outside */
    const char *json_path; /* NULL = none */
    int64_t seeds;
    const real_table *real; /* of real recordings; NULL = not asked for */
} eval_report_options;

/* Prints the table, writes the JSON and sets *out_outside to the number of figures that are outside
 * their bounds. */
rlf_result eval_report(const eval_table *table, const eval_report_options *options,
                       int32_t *out_outside);

#endif
