/* Bodies that sensed surfaces carry. */
#ifndef RELIEF_APP_EVAL_SENSED_HOLD_H
#define RELIEF_APP_EVAL_SENSED_HOLD_H

#include "relief/pipeline.h"

/* LIFT, SWIPE, CARRY: what stayed on or before the tray. `error` is the leaving speed's, relative.
 */
rlf_result eval_sensed_lift(rlf_profile profile, rlf_shape_type shape, double speed, bool *out_good,
                            double *out_error);
rlf_result eval_sensed_swipe(rlf_profile profile, rlf_shape_type shape, double speed,
                             bool *out_good);
rlf_result eval_sensed_carry(rlf_profile profile, int32_t *out_stayed);

typedef struct eval_rest {
    double jitter_mm; /* RMS about the mean place, from 0.3 s after the last bounce of its landing
                         on; NAN: it never came to rest there */
    double awake_mm;  /* the same while it does not sleep yet */
    double asleep_s;  /* s from the first touch to sleep; EVAL_NEVER = never */
    int32_t wakes;
} eval_rest;

/* NOISE: a cube on the sensed table. */
rlf_result eval_sensed_rest(rlf_profile profile, double seconds, eval_rest *out);
/* CHAIR: frames from its removal until the cube on its seat falls; EVAL_NEVER = never. */
rlf_result eval_sensed_chair(rlf_profile profile, double *out_frames);

#endif
