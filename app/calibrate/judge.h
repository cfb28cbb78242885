/* Whether the views can determine the cameras, and what of the picture they cover. */
#ifndef RELIEF_APP_CALIBRATE_JUDGE_H
#define RELIEF_APP_CALIBRATE_JUDGE_H

#include "calibrate/solve.h"

#define CALIBRATE_VIEWS_LEAST 5

#define COVERAGE_COLUMNS 8
#define COVERAGE_ROWS 6

/* Where in one camera's picture corners were seen. */
typedef struct calibrate_coverage {
    bool cells[COVERAGE_ROWS][COVERAGE_COLUMNS];
    double share;     /* of the cells */
    double box[4];    /* left, top, right, bottom of all corners, as shares of the picture */
    char missing[96]; /* ninths of the picture without any, in words: "upper left, right" */
} calibrate_coverage;

void calibrate_cover(const calibrate_views *views, int32_t camera, calibrate_coverage *out);
/* Largest angle between the normals of two used boards, degrees. */
double calibrate_tilt_spread(const calibrate_views *views);
/* Before anything is solved: enough views that differ. */
rlf_result calibrate_judge_views(const calibrate_views *views, const calibrate_model *model);
/* After: RLF_ERROR_INVALID with the reason when the fit is not to be trusted. Warnings go to the
 * log. */
rlf_result calibrate_judge_fit(const calibrate_views *views, const calibrate_model *model,
                               const calibrate_fit *fit);

#endif
