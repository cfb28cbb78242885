/* A lens model from the fields of view that a device or a file tells. */
#ifndef RLF_IO_DRIVER_FIELD_OF_VIEW_H
#define RLF_IO_DRIVER_FIELD_OF_VIEW_H

#include "relief/camera.h"

/* Angles in radians. The fields of view cover whole pixels, so the centre lies between the middle
 * ones. False: they are no angles, and out is a typical PrimeSense camera (58 degrees). */
bool io_camera_from_fov(int32_t width, int32_t height, double fov_x, double fov_y, rlf_camera *out);

#endif
