/* The cameras that explain the views: seed, solution, how good it is, and whether to trust it. */
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

/* ---- linear.c: symmetric positive definite systems of the sizes that calibration has */

#define LINEAR_MAX 24

/* Inverse of the n x n matrix `a` (rows of n numbers), n <= LINEAR_MAX, by Cholesky's L L^T with
 * rows scaled to a unit diagonal. False, and `out` not set, when it is not positive definite. */
bool linear_invert(int32_t n, const double *a, double *out);

/* ---- sight_model.c: one corner's pixel error and its derivatives by everything that moves it */

typedef struct sight_term {
    double error[2];                    /* predicted minus seen, pixels */
    double shared[2][CALIBRATE_SHARED]; /* d error / d shared unknown */
    double own[2][6];                   /* d error / d rotation, translation of the board */
} sight_term;

/* Term of corner `index` of a camera's sight; where the board is behind the camera, the error is
 * large and the derivatives are 0. */
void sight_linearise(const calibrate_view *view, const calibrate_model *model, int32_t camera,
                     int32_t index, sight_term *out);

/* ---- seed.c: where the optimisation begins: OpenCV's calibration of each camera by itself */

/* Sets lenses that are not fixed, the motion between the cameras and the views' poses. A camera
 * whose distortion is fixed keeps its lens, and its views get their poses from the other camera.
 * Boards that one camera saw turned by half a turn are turned back. */
rlf_result calibrate_seed(const relief_opencv_api *api, calibrate_views *views,
                          calibrate_model *model);

/* OpenCV's own optimum of the same views of both cameras, to compare: model has the start and takes
 * the result. RLF_ERROR_INVALID when OpenCV gives up. */
rlf_result calibrate_opencv_stereo(const relief_opencv_api *api, const calibrate_views *views,
                                   calibrate_model *model, double *out_rms);

/* ---- quality.c: how good a calibration is, measured on what it was not fitted to and on what it
 * is for */

/* RMS (pixels) of one camera's views, each predicted by a lens solved from all others; only its
 * pose comes from itself. NAN with fewer than three views. */
rlf_result calibrate_leave_one_out(const calibrate_views *views, const calibrate_model *model,
                                   int32_t camera, double *out_rms);
/* Mean distance of the corners from their epipolar lines, pixels, lenses' distortion taken away;
 * NAN without views of both cameras. */
double calibrate_epipolar(const calibrate_views *views, const calibrate_model *model);

/* Where a depth pixel lands in the second camera. */
bool calibrate_map(const calibrate_model *model, double u, double v, double depth_m,
                   double out_pixel[2]);
/* Grid of depth pixels and distances over which maps are compared: point `index` of
 * CALIBRATE_MAP_POINTS; the distances are 0.6, 1 and 2 times `distance_m`. */
#define CALIBRATE_MAP_POINTS (16 * 12 * 3)
void calibrate_map_point(const rlf_camera *camera, double distance_m, int32_t index, double *out_u,
                         double *out_v, double *out_depth_m);
/* Median distance of the used boards from the first camera, metres. */
double calibrate_distance(const calibrate_views *views);
/* Standard deviation of where depth lands, by the fit's covariance: what 95 % of the points stay
 * below, pixels. */
double calibrate_map_deviation(const calibrate_model *model, const calibrate_fit *fit,
                               double distance_m);

/* ---- judge.c: whether the views can determine the cameras, and what of the picture they cover */

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
