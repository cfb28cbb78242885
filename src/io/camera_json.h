/* camera.json from memory. */
#ifndef RLF_IO_CAMERA_JSON_H
#define RLF_IO_CAMERA_JSON_H

#include "io/file.h"
#include "io/json.h"
#include "relief/camera.h"
#include "relief/frame.h"

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

#endif
