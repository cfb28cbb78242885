/* Normals of a run against ground truth; counts over frames and seeds, as in each of these. */
#ifndef RELIEF_APP_EVAL_MEASURES_NORMALS_H
#define RELIEF_APP_EVAL_MEASURES_NORMALS_H

#include "eval/measures/angles.h"
#include "relief/surface.h"
#include "relief/synthetic.h"

/* Samples inside surfaces, and within 6 pixels (full resolution) of a depth jump. */
typedef struct eval_normals {
    eval_angles interior, band;
    eval_angles seen;  /* of the band, without filled pixels */
    eval_angles shown; /* of the band, against the true surface that the pixel's own depth shows */
} eval_normals;

/* Marks pixels within 6 of a jump (neighbours whose depths differ by more than 4 % of the nearer).
 * out and scratch hold width * height bytes. */
void eval_mark_band(const float *depth, int32_t width, int32_t height, uint8_t *out,
                    uint8_t *scratch);
void eval_normals_add(eval_normals *e, const rlf_surface *surface, const rlf_truth *truth,
                      const rlf_rig *rig, const uint8_t *band);

#endif
