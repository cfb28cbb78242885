/* The thesis's own experiment. */
#ifndef RELIEF_APP_EVAL_MEASURES_CENTRE_H
#define RELIEF_APP_EVAL_MEASURES_CENTRE_H

#include "relief/surface.h"
#include "relief/synthetic.h"

/* The thesis's own experiment: the centre (56 x 47 of 64 x 53 points) of its grid of every 8th
 * pixel, in frames that show something moving. Finer grids are sampled at the same pixels. */
typedef struct eval_centre {
    int64_t points;  /* with a true surface in range */
    int64_t wrong;   /* of them, normal more than 30 degrees off */
    int64_t missing; /* of them, without a normal */
} eval_centre;

void eval_centre_add(eval_centre *e, const rlf_surface *surface, const rlf_truth *truth,
                     const rlf_rig *rig);

#endif
