/* What is known of the room where somebody hides it: the background sheet against the simulator's
 * room without its foreground. */
#ifndef RELIEF_APP_EVAL_MEASURES_BEHIND_H
#define RELIEF_APP_EVAL_MEASURES_BEHIND_H

#include "eval/measures/angles.h"
#include "relief/surface.h"
#include "relief/synthetic.h"

typedef struct eval_behind {
    int64_t pixels;    /* that the true foreground hides, in range */
    int64_t missing;   /* of them, without a background */
    int64_t off;       /* of them, whose background is more than 4 cm off */
    int64_t count;     /* the others: square_sum's */
    double square_sum; /* m^2 */
    eval_angles angles;
    float *depth;       /* true background that `normal` belongs to; 0 = not asked yet */
    float (*normal)[3]; /* per depth pixel */
    rlf_source *source; /* that is asked for true normals */
} eval_behind;

/* For a run of `source`, which must outlive it. RLF_ERROR_MEMORY. */
rlf_result eval_behind_init(eval_behind *e, rlf_source *source);
void eval_behind_finish(eval_behind *e);
/* Nothing while the background is being learned. */
void eval_behind_add(eval_behind *e, const rlf_surface *surface, const rlf_truth *truth);

/* NAN when there is no sample. The RMS is of the errors below 4 cm; the share of all that have a
 * background. */
double eval_behind_rms_mm(const eval_behind *e);
double eval_behind_off_percent(const eval_behind *e);
double eval_behind_missing_percent(const eval_behind *e);

#endif
