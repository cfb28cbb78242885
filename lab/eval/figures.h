/* The figures of one run on a synthetic scene. */
#ifndef RELIEF_APP_EVAL_FIGURES_H
#define RELIEF_APP_EVAL_FIGURES_H

#include "eval/measures/behind.h"
#include "eval/measures/centre.h"
#include "eval/measures/collisions.h"
#include "eval/measures/depth.h"
#include "eval/measures/distance.h"
#include "eval/measures/foreground.h"
#include "eval/measures/normals.h"
#include "eval/measures/solid.h"

/* Everything measured for one profile. */
typedef struct eval_measures {
    eval_depth depth;
    eval_normals normals;
    eval_centre centre;
    eval_foreground foreground;
    eval_solid solid;
    eval_behind behind;
    eval_collisions collisions;
    eval_distance distance;
} eval_measures;

#define EVAL_FIGURES_MAX 80

/* At most EVAL_FIGURES_MAX. */
int32_t eval_figure_count(void);
const char *eval_figure_key(int32_t index);
const char *eval_figure_title(int32_t index);
/* eval_figure_count values; NAN where there was nothing to measure. */
void eval_figures_get(const eval_measures *m, double *values);

#endif
