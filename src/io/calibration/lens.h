/* One camera of another program's calibration file. */
#ifndef RLF_IO_CALIBRATION_LENS_H
#define RLF_IO_CALIBRATION_LENS_H

#include "io/json.h"
#include "relief/frame.h"

/* Array of at most `max` numbers under the first of the names (NULL ends them) that is there; below
 * it also `data`, as matrices have it. *out_count 0 = none of them is there. */
rlf_result io_calibration_numbers(const io_json_object *top, const char *const *names, double *out,
                                  size_t max, size_t *out_count);

/* Coefficients in OpenCV's order; those of models that are not read must be 0. */
rlf_result io_calibration_set_coefficients(const io_json_object *top, const double *k, size_t count,
                                           rlf_camera *out);
/* Whether focal lengths and centre are in pixels of pictures of its size. */
rlf_result io_calibration_check_lens(const io_json_object *top, const rlf_camera *camera);
/* T_color_depth from three rows of R and the three of t, `row` and `step` numbers apart, with
 * camera.json's check of rotations and of metres. */
rlf_result io_calibration_set_motion(const io_json_object *top, const double *r, size_t row,
                                     const double *t, size_t step, rlf_rig *out);

/* Whether there is a matrix, or a size, under a name of ROS or OpenCV. */
bool io_calibration_has_matrix(const io_json_object *top);
/* ROS camera_info and OpenCV: sizes, a 3x3 matrix, coefficients. `second`: the second camera of a
 * pair in one file of OpenCV. Of ROS also the region of interest and the binning. */
rlf_result io_calibration_read_matrix(const io_json_object *top, bool second, rlf_camera *out);
/* Open3D: PinholeCameraIntrinsic, or the one in PinholeCameraParameters. */
rlf_result io_calibration_read_open3d(const io_json_object *top, rlf_camera *out);
/* mrcal: LENSMODEL_PINHOLE and LENSMODEL_OPENCV4, 5 and 8; the pose of its reference in it. */
rlf_result io_calibration_read_mrcal(const io_json_object *top, rlf_camera *out,
                                     rlf_pose *out_T_camera_reference);

#endif
