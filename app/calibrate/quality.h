/* How good a calibration is, measured on what it was not fitted to and on what it is for. */
#ifndef RELIEF_APP_CALIBRATE_QUALITY_H
#define RELIEF_APP_CALIBRATE_QUALITY_H

#include "calibrate/solve.h"

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

#endif
