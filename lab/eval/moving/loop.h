/* The whole loop with a camera that moves: foreground against the truth, and its time. */
#ifndef RELIEF_APP_EVAL_MOVING_LOOP_H
#define RELIEF_APP_EVAL_MOVING_LOOP_H

#include "relief/base.h"

typedef struct loop_figures {
    double f, f_valid;        /* F-measure: of all pixels, and of those with depth; 0..1 */
    double precision, recall; /* of those with depth */
    double loop_ms; /* surface, physics and a 960 x 540 picture; a frame, median, wall time */
} loop_figures;

/* Plays a synthetic SOURCE with two cubes, and measures from frame `from` on. */
rlf_result loop_measure(const char *source, int64_t from, loop_figures *out);

#endif
