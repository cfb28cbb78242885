/* What one person differs in from another: size, build, clothes and gait. */
#ifndef RLF_SIM_FIGURE_H
#define RLF_SIM_FIGURE_H

#include "sim/flesh.h"

typedef struct synth_figure {
    double trunk, leg, arm; /* lengths, of those of an adult of 1.75 m */
    double shoulder, hip;   /* metres from the middle plane to the joints */
    double shoulder_height; /* metres above the hips */
    double clear;           /* metres that the hands hang farther out, past the hips */
    double pace;            /* speed of a walk that enters or leaves, of the script's */
    double step;            /* metres between footfalls of opposite feet, about */
    synth_flesh flesh[SYNTH_PERSON_FLESH];
} synth_figure;

/* The figure of seed 1 is an adult of 1.75 m; every other seed draws one, and for `second`
 * another. */
void synth_figure_make(synth_figure *figure, uint64_t seed, bool second);

#endif
