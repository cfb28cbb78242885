/* How far a matte is off. */
#ifndef RELIEF_APP_EVAL_PICTURE_EDGES_H
#define RELIEF_APP_EVAL_PICTURE_EDGES_H

#include "eval/picture/truth.h"

#define PICTURE_BINS 640 /* of displacement, 1/40 pixel each: to 16 pixels */

/* Distances between edges, in bins of 1/40 pixel. */
typedef struct picture_distances {
    int64_t bins[PICTURE_BINS];
    int64_t count;
    double sum;
} picture_distances;

typedef struct picture_errors {
    picture_distances person, things; /* what hides the body */
    int64_t hidden, both_hidden, either_hidden;
    double band_sum; /* of |alpha - truth| */
    int64_t band_count;
    int64_t pixels, order, order_far; /* wrong though depths differ by 5 cm; beyond 3 pixels */
    double flicker_sum;
    int64_t flicker_count;
} picture_errors;

/* Adds one picture. `alpha` and `before` (may be NULL: the picture before, for flicker) have a
 * value per pixel. */
void picture_errors_add(picture_errors *e, const picture_truth *t, const float *alpha,
                        const float *before);
/* NAN when there is no edge. */
double picture_mean(const picture_distances *d);
double picture_percentile(const picture_distances *d, double percent);

#endif
