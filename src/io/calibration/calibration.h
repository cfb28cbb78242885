/* Files of calibrations, of Relief and of other programs. */
#ifndef RLF_IO_CALIBRATION_CALIBRATION_H
#define RLF_IO_CALIBRATION_CALIBRATION_H

#include "io/file.h"
#include "io/json.h"
#include "relief/camera.h"
#include "relief/frame.h"

#include <jansson.h>

/* ---- camera.json from memory ---- */

rlf_result io_rig_parse(const io_bytes *file, rlf_rig *out, double *out_units_per_metre);

/* The same of a parsed document. */
rlf_result io_rig_from_json(const io_json_object *top, rlf_rig *out, double *out_units_per_metre);
/* Only its depth_to_color, into rig->T_color_depth; left as it is where there is none. */
rlf_result io_rig_read_motion(const io_json_object *top, rlf_rig *rig);

/* The rotation of a matrix, row by row. False, and *out left alone, for a mirror or where an entry
 * of |R R^T - 1| is above the tolerance. */
bool io_rotation_read(const double rows[9], double tolerance, rlf_quat *out);

/* ---- A camera that gives a part of its picture, or joins neighbouring pixels ---- */

/* As ROS's CameraInfo has it: in pixels of the whole picture, before they are joined. */
typedef struct io_camera_window {
    uint32_t x, y, width, height;  /* width and height 0: all of it */
    uint32_t binning_x, binning_y; /* so many pixels become one; 0 and 1: none do */
} io_camera_window;

/* Turns the camera of the whole picture into that of the window. False, and nothing changed, when
 * the window lies outside the picture or leaves no pixel. */
bool io_camera_window_apply(const io_camera_window *window, rlf_camera *camera);

/* ---- What a file that is given as a calibration is ---- */

typedef enum io_calibration_kind {
    IO_CALIBRATION_JSON = 0,
    IO_CALIBRATION_TEXT, /* YAML, or a Python dictionary */
    IO_CALIBRATION_XML
} io_calibration_kind;

/* By what is in it, and by its name where that leaves two. A file that is empty, or holds bytes
 * that no text has, is refused as what it looks like. */
rlf_result io_calibration_kind_of(const io_bytes *file, io_calibration_kind *out);

/* The error for a document with none of the keys that are read: says what it looks like. */
rlf_result io_calibration_fail_unknown(const io_json_object *top);

/* Text of other programs' calibration files as a JSON value: the part of YAML that ROS and OpenCV
 * write, and the Python dictionary of mrcal. */

#define IO_CALIBRATION_FILE_MAX ((size_t)1 << 20)

/* Reads block mappings, lists of plain values, flow lists and maps, quoted and plain values, tags
 * and comments; anchors, block texts and lists of blocks are errors. A key given twice is one too.
 * The top must be a mapping. json_decref(*out). */
rlf_result io_calibration_text_parse(const io_bytes *file, json_t **out);

/* ---- OpenCV's FileStorage in XML as a JSON value ---- */

/* Reads what cv::FileStorage writes: the elements of <opencv_storage> are keys. An element holds
 * elements, one number or text, or several numbers with blanks between. Attributes and comments are
 * passed over. Other XML is an error. json_decref(*out). */
rlf_result io_calibration_xml_parse(const io_bytes *file, json_t **out);

/* ---- Camera chains of kalibr ---- */

bool io_calibration_is_kalibr(const io_json_object *top);

/* cam0 is the depth camera and cam1, if it is there, colour: with resolution, intrinsics (fu fv pu
 * pv), distortion_model (radtan or none) and T_cn_cnm1. Others are left out with a warning.
 * *out_has_motion: T_color_depth was read. */
rlf_result io_calibration_read_kalibr(const io_json_object *top, rlf_rig *out,
                                      bool *out_has_motion);

/* ---- One camera of another program's calibration file ---- */

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
