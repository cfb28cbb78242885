/* What each figure of `relief-lab eval` is meant to reach, and what it must not get worse than. */
#ifndef RELIEF_APP_EVAL_BOUNDS_H
#define RELIEF_APP_EVAL_BOUNDS_H

#include "eval/table.h"

typedef struct eval_bound {
    const char *scene, *key;
    char relation; /* '<': at most, '>': at least */
    double goal;   /* of the design; NAN = none */
    double bound;  /* the mean over seeds must keep it, else the command fails; NAN = a goal only */
    /* For the reader: what the thesis reports, or what its method was measured to reach, and what
     * other systems reach; "" = nobody measured it. */
    const char *thesis, *others;
} eval_bound;

typedef enum eval_verdict {
    EVAL_GOAL_MET = 0,
    EVAL_WITHIN_BOUND = 1, /* short of the goal, no worse than the bound; or there is no goal */
    EVAL_OUTSIDE = 2,
    EVAL_NOT_MEASURED = 3
} eval_verdict;

extern const eval_bound eval_bounds[];
extern const int32_t eval_bound_count;

/* NULL for a figure that has neither. */
const eval_bound *eval_bound_find(const char *scene, const char *key);
/* Whether any figure of a scene or section has a bound. */
bool eval_has_bounds(const char *scene);
/* Judges a mean; NAN was not measured. */
eval_verdict eval_bound_judge(const eval_bound *bound, double mean);
/* "goal", "bound", "OUTSIDE", "no sample". */
const char *eval_verdict_name(eval_verdict verdict);

#endif
