/* Foreground of a run against ground truth. */
#ifndef RELIEF_APP_EVAL_MEASURES_FOREGROUND_H
#define RELIEF_APP_EVAL_MEASURES_FOREGROUND_H

#include "relief/surface.h"
#include "relief/synthetic.h"

typedef struct eval_confusion {
    int64_t true_positive, false_positive, false_negative, true_negative;
} eval_confusion;

/* Foreground against truth, on all pixels and where the sensor gave a depth. */
typedef struct eval_foreground {
    eval_confusion all, valid;
} eval_foreground;

void eval_foreground_add(eval_foreground *e, const rlf_surface *surface, const rlf_truth *truth,
                         const rlf_rig *rig);
double eval_precision(const eval_confusion *c);
double eval_recall(const eval_confusion *c);
double eval_f_measure(const eval_confusion *c);

#endif
