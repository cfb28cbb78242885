/* Pictures of a calibration's report: before it and after it. */
#ifndef RELIEF_APP_CALIBRATE_REPORT_PICTURES_H
#define RELIEF_APP_CALIBRATE_REPORT_PICTURES_H

#include "calibrate/calibrate.h"

/* Writes DIR/before.png and DIR/after.png: of folders a pair as it is and rectified, with level
 * lines; of a source its colour picture with the edges of depth in red. *out_count: how many were
 * written, 0 or 2. */
rlf_result calibrate_report_pictures(const calibrate_options *options, const calibration *c,
                                     int *out_count);

#endif
