/* Camera chains of kalibr. */
#ifndef RLF_IO_CALIBRATION_KALIBR_H
#define RLF_IO_CALIBRATION_KALIBR_H

#include "io/json.h"
#include "relief/frame.h"

bool io_calibration_is_kalibr(const io_json_object *top);

/* cam0 is the depth camera and cam1, if it is there, colour: with resolution, intrinsics (fu fv pu
 * pv), distortion_model (radtan or none) and T_cn_cnm1. Others are left out with a warning.
 * *out_has_motion: T_color_depth was read. */
rlf_result io_calibration_read_kalibr(const io_json_object *top, rlf_rig *out,
                                      bool *out_has_motion);

#endif
