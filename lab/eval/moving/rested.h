/* Bodies at rest in a room while the camera looks away from them and back. */
#ifndef RELIEF_APP_EVAL_MOVING_RESTED_H
#define RELIEF_APP_EVAL_MOVING_RESTED_H

#include "relief/base.h"

/* How many bodies ... */
typedef struct rested_figures {
    int32_t put;
    int32_t lost;  /* left the world */
    int32_t flung; /* were more than 5 cm from where they were put */
    int32_t sunk;  /* the same, 2 cm lower */
    int32_t woken; /* slept, and did not for a frame after */
} rested_figures;

/* `source`: a synthetic room through which the camera moves; adds up. */
rlf_result rested_measure(const char *source, int64_t seed, rested_figures *out);

#endif
