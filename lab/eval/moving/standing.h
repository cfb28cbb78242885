/* Whether a clip's camera stands or moves, as the frame loop decides by default. */
#ifndef RELIEF_APP_EVAL_MOVING_STANDING_H
#define RELIEF_APP_EVAL_MOVING_STANDING_H

#include "relief/base.h"

/* What is done to a clip's frames. */
typedef enum standing_case {
    STANDING_AS_IT_IS = 0,
    STANDING_PERSON = 1, /* somebody near turns about, and fills half of the view */
    STANDING_DARK = 2    /* the light is switched off after 20 frames, and on after 35 */
} standing_case;

typedef struct standing_figures {
    int32_t frames, alarms; /* alarms: it is taken to move though it does not */
    double jump_mm;         /* largest change of the pose against the truth when it stands again */
    double snap_mm;         /* the same when it is told that it moves */
    int32_t told;           /* frames until a true motion is told; -1: none, or never */
    double stands_s;        /* until it stands again after the truth does; -1: no, or never */
    double wait_s;          /* that bodies waited at longest */
} standing_figures;

/* Poses of the source are the truth, and are hidden from the loop. `frames` 0: all. */
rlf_result standing_measure(const char *source, standing_case kind, int64_t frames,
                            standing_figures *out);

/* One line on stderr. */
void standing_tell(const char *name, const standing_figures *f);

#endif
