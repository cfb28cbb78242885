/* The model of a hand, fitted to its pixels. */
#ifndef RLF_HANDS_FIT_H
#define RLF_HANDS_FIT_H

#include "hands/crop.h"
#include "hands/model.h"

/* A pose and how ill it fits. */
typedef struct hand_fit {
    hand_model_pose pose;
    double energy; /* of its pixels, of what must be empty, and of odd poses; 0 is perfect */
    double seen;   /* the part of the pixels alone */
} hand_fit;

/* Improves a fit by Gauss-Newton steps with every `stride`-th sample; `before`, which may be NULL,
 * is the pose of the frame before. Energy is that of the last step's beginning. */
void hand_fit_improve(hand_fit *fit, const hand_crop *crop, const hand_model_pose *before,
                      int32_t steps, int32_t stride);

/* Energy of one of the crop's samples that is `off` metres off, where all are; *less: how much of
 * its pull is left. */
double hand_fit_robust(const hand_crop *crop, double off, double *less);

/* The energy alone. */
void hand_fit_judge(hand_fit *fit, const hand_crop *crop, int32_t stride);

#endif
