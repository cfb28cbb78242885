/* Error against distance: depth before and after the surface stage, and normals. */
#ifndef RELIEF_APP_EVAL_MEASURES_DISTANCE_H
#define RELIEF_APP_EVAL_MEASURES_DISTANCE_H

#include "relief/io.h"

#define EVAL_DISTANCE_BINS 8 /* of half a metre, from 0.5 m */

typedef struct eval_distance_bin {
    double raw_square_sum, square_sum; /* m^2 */
    int64_t raw_count, count;
    double angle_sum; /* degrees */
    int64_t angle_count;
} eval_distance_bin;

/* Pixels by their true distance, without those at depth edges. */
typedef struct eval_distance {
    eval_distance_bin bins[EVAL_DISTANCE_BINS];
} eval_distance;

/* band: 1 at the pixels to leave out, of the depth camera's size; see eval_mark_band. */
void eval_distance_add(eval_distance *e, const rlf_surface *surface, const rlf_frame *frame,
                       const rlf_truth *truth, const uint8_t *band);

/* Three figures per bin; as those of figures.h. */
int32_t eval_distance_count(void);
const char *eval_distance_key(int32_t index);
const char *eval_distance_title(int32_t index);
double eval_distance_value(const eval_distance *e, int32_t index);

#endif
