/* 1000 bodies thrown while the camera turns over the room and back. */
#ifndef RELIEF_APP_EVAL_MOVING_THROWN_H
#define RELIEF_APP_EVAL_MOVING_THROWN_H

#include "relief/base.h"

/* Of 1000 bodies, three seconds after the camera is back. */
typedef struct thrown_figures {
    int32_t gone;          /* left the world */
    int32_t sunk, hanging; /* more than 1 cm inside of the true room, or over it */
    int32_t restless;      /* there, but not asleep yet */
    double surface_ms;     /* contacts with grid and map, a frame, mean */
} thrown_figures;

rlf_result thrown_measure(int64_t seed, thrown_figures *out);

#endif
