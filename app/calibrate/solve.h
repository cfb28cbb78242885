/* Lenses, the motion between two cameras and every board's pose, all views in one optimisation:
 * least squares of the corners' pixels (bundle adjustment; Triggs et al. 2000). */
#ifndef RELIEF_APP_CALIBRATE_SOLVE_H
#define RELIEF_APP_CALIBRATE_SOLVE_H

#include "calibrate/views.h"

/* Unknowns that all views share: fx fy cx cy k1 k2 p1 p2 k3 of each camera, then rotation (radians)
 * and translation (metres) of T_second_first. */
#define CALIBRATE_LENS 9
#define CALIBRATE_MOTION (2 * CALIBRATE_LENS)
#define CALIBRATE_SHARED (CALIBRATE_MOTION + 6)

typedef struct calibrate_model {
    rlf_camera camera[CALIBRATE_CAMERAS]; /* RLF_DISTORTION_PLUMB_BOB */
    rlf_pose T_second_first;              /* p_second = T p_first */
    bool is_fixed[CALIBRATE_SHARED];      /* not an unknown */
} calibrate_model;

typedef struct calibrate_fit {
    double rms;                       /* sqrt(sum |e|^2 / corners), pixels, both cameras */
    double rms_of[CALIBRATE_CAMERAS]; /* of one; NAN = it sees nothing */
    double sigma;       /* of one pixel coordinate, from the residuals and the degrees of freedom */
    bool is_determined; /* the views settle every unknown, and the covariance is set */
    double covariance[CALIBRATE_SHARED][CALIBRATE_SHARED]; /* of the shared; 0 where fixed */
} calibrate_fit;

/* Levenberg-Marquardt from `model` and the views' poses, which it replaces; only views that are
 * used. RLF_ERROR_MEMORY or RLF_OK. */
rlf_result calibrate_solve(calibrate_views *views, calibrate_model *model, calibrate_fit *out);
/* Errors (pixels) of each corner of a view at a camera, du dv du dv ...; `out` may be NULL. Returns
 * the sum of their squares. */
double calibrate_errors(const calibrate_view *view, const calibrate_model *model, int32_t camera,
                        double *out);
/* sqrt(mean |e|^2) of one view, both cameras. */
double calibrate_view_rms(const calibrate_view *view, const calibrate_model *model);
/* Adds a step to the shared unknowns. */
void calibrate_move(calibrate_model *model, const double step[CALIBRATE_SHARED]);

/* Standard deviation of the unknown `index`. */
double calibrate_deviation(const calibrate_fit *fit, int32_t index);

#endif
