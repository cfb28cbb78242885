/* Where the optimisation begins: OpenCV's calibration of each camera by itself. */
#ifndef RELIEF_APP_CALIBRATE_SEED_H
#define RELIEF_APP_CALIBRATE_SEED_H

#include "calibrate/opencv/opencv.h"
#include "calibrate/solve.h"

/* Sets lenses that are not fixed, the motion between the cameras and the views' poses. A camera
 * whose distortion is fixed keeps its lens, and its views get their poses from the other camera.
 * Boards that one camera saw turned by half a turn are turned back. */
rlf_result calibrate_seed(const relief_opencv_api *api, calibrate_views *views,
                          calibrate_model *model);

/* OpenCV's own optimum of the same views of both cameras, to compare: model has the start and takes
 * the result. RLF_ERROR_INVALID when OpenCV gives up. */
rlf_result calibrate_opencv_stereo(const relief_opencv_api *api, const calibrate_views *views,
                                   calibrate_model *model, double *out_rms);

#endif
