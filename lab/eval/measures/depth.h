/* Depth of a run against ground truth. */
#ifndef RELIEF_APP_EVAL_MEASURES_DEPTH_H
#define RELIEF_APP_EVAL_MEASURES_DEPTH_H

#include "relief/surface.h"
#include "relief/synthetic.h"

/* Depth samples against truth. */
typedef struct eval_depth_errors {
    int64_t pixels;     /* with a true surface in range */
    int64_t missing;    /* of them, without depth */
    int64_t flying;     /* farther than 4 cm from every true depth of the 3x3 neighbourhood */
    int64_t other_side; /* farther than 4 cm from the pixel's own true depth */
    int64_t count;      /* the others: square_sum's */
    double square_sum;  /* m^2 */
} eval_depth_errors;

typedef struct eval_depth_group {
    eval_depth_errors raw, seen, filled; /* the surface's pixels without depth are in `seen` */
} eval_depth_group;

/* Pixels whose truth has not changed for a second, and pixels whose truth is new in this frame (all
 * of the first frame's): what one frame alone must give. */
typedef struct eval_depth {
    eval_depth_group still, moving;
    float *last;       /* true depth of the frame before */
    int64_t *since_ns; /* when it became so */
} eval_depth;

rlf_result eval_depth_init(eval_depth *e, const rlf_camera *camera);
void eval_depth_finish(eval_depth *e);
void eval_depth_add(eval_depth *e, const rlf_surface *surface, const rlf_frame *frame,
                    const rlf_truth *truth);
/* The frame's depth at a pixel as it came, metres; <= 0 = missing. */
float eval_raw_depth(const rlf_frame *frame, int32_t x, int32_t y);
/* RMS of the errors below 4 cm. */
double eval_depth_rms_mm(const eval_depth_errors *e);
/* Shares of the samples with depth. */
double eval_depth_flying_percent(const eval_depth_errors *e);
double eval_depth_other_side_percent(const eval_depth_errors *e);
/* Shares of all pixels. */
double eval_depth_raw_missing_percent(const eval_depth_group *g);
double eval_depth_missing_percent(const eval_depth_group *g);
double eval_depth_filled_percent(const eval_depth_group *g);

#endif
