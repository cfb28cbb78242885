/* Depth pictures that belong to the infrared pictures of a folder. */
#ifndef RELIEF_APP_CALIBRATE_FOLDER_DEPTH_H
#define RELIEF_APP_CALIBRATE_FOLDER_DEPTH_H

#include "calibrate/calibrate.h"

/* Reads the 16-bit PNG of each view, found by its number, and measures the depth offset. */
rlf_result calibrate_folder_depth(const calibrate_options *options, calibration *c);

#endif
