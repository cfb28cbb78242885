/* librelief_opencv.so, opened when it is first needed. */
#ifndef RELIEF_APP_CALIBRATE_OPENCV_OPENCV_H
#define RELIEF_APP_CALIBRATE_OPENCV_OPENCV_H

#include "calibrate/opencv/shim.h"

/* NULL with an error line that names the package to install. Thread-safety: safe, and so are its
 * functions. */
const relief_opencv_api *opencv_get(void);

#endif
