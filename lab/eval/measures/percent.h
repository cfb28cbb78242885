/* A share of what was measured. */
#ifndef RELIEF_APP_EVAL_MEASURES_PERCENT_H
#define RELIEF_APP_EVAL_MEASURES_PERCENT_H

#include <math.h>
#include <stdint.h>

/* NAN when there was nothing to measure: a figure without samples is not a figure of 0. */
static inline double eval_percent(int64_t part, int64_t whole)
{
    return whole > 0 ? 100.0 * (double)part / (double)whole : NAN;
}

#endif
