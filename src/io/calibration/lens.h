/* One camera of another program's calibration file. */
#ifndef RLF_IO_CALIBRATION_LENS_H
#define RLF_IO_CALIBRATION_LENS_H

#include "relief/camera.h"
#include "io/json.h"

/* Array of at most `max` numbers under the first of the names (NULL ends them) that is there; below
 * it also `data`, as matrices have it. *out_count 0 = none of them is there. */
rlf_result io_calibration_numbers(const io_json_object *top, const char *const *names, double *out,
                                  size_t max, size_t *out_count);

/* ROS camera_info and OpenCV: sizes, a 3x3 matrix, coefficients. `second`: the second camera of a
 * pair in one file of OpenCV. */
rlf_result io_calibration_read_matrix(const io_json_object *top, bool second, rlf_camera *out);
/* Open3D: PinholeCameraIntrinsic, or the one in PinholeCameraParameters. */
rlf_result io_calibration_read_open3d(const io_json_object *top, rlf_camera *out);
/* mrcal: LENSMODEL_PINHOLE and LENSMODEL_OPENCV4, 5 and 8; the pose of its reference in it. */
rlf_result io_calibration_read_mrcal(const io_json_object *top, rlf_camera *out,
                                     rlf_pose *out_T_camera_reference);

#endif
