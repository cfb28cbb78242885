/* Distribution of angles between estimated and true normals. */
#ifndef RELIEF_APP_EVAL_MEASURES_ANGLES_H
#define RELIEF_APP_EVAL_MEASURES_ANGLES_H

#include "eval/measures/percent.h"

#define EVAL_ANGLE_BINS 18000 /* 0.01 degrees each */

typedef struct eval_angles {
    int64_t bins[EVAL_ANGLE_BINS];
    double sum_deg;
    int64_t count;   /* samples with both normals */
    int64_t wrong;   /* of them, more than 30 degrees off */
    int64_t missing; /* samples with a true surface in range but no normal */
} eval_angles;

double eval_median_deg(const eval_angles *angles);
double eval_mean_deg(const eval_angles *angles);
/* Shares in percent. These and the two above are NAN when there is no sample. */
double eval_wrong_percent(const eval_angles *angles);
double eval_missing_percent(const eval_angles *angles);
/* Share of the angles below `degrees`, to 0.01 degrees. */
double eval_within_percent(const eval_angles *angles, double degrees);
void eval_add_angle(eval_angles *angles, double degrees);

#endif
