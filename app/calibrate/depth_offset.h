/* The constant by which a camera measures too far, from boards whose pose is known. */
#ifndef RELIEF_APP_CALIBRATE_DEPTH_OFFSET_H
#define RELIEF_APP_CALIBRATE_DEPTH_OFFSET_H

#include "calibrate/calibrate.h"

/* Median over the board's pixels of measured depth minus that of its plane, metres; NAN where less
 * than half of the lattice has depth or it is not all in the picture. `depth` is the first camera's
 * picture, metres, 0 = missing. */
double depth_offset_on(const calibrate_view *view, const calibrate_board *board,
                       const rlf_camera *camera, const float *depth);
/* Mean of the views' offsets and its standard deviation into the calibration. */
void depth_offset_combine(calibration *c);

#endif
