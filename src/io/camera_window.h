/* A camera that gives a part of its picture, or joins neighbouring pixels. */
#ifndef RLF_IO_CAMERA_WINDOW_H
#define RLF_IO_CAMERA_WINDOW_H

#include "relief/camera.h"

/* As ROS's CameraInfo has it: in pixels of the whole picture, before they are joined. */
typedef struct io_camera_window {
    uint32_t x, y, width, height;  /* width and height 0: all of it */
    uint32_t binning_x, binning_y; /* so many pixels become one; 0 and 1: none do */
} io_camera_window;

/* Turns the camera of the whole picture into that of the window. False, and nothing changed, when
 * the window lies outside the picture or leaves no pixel. */
bool io_camera_window_apply(const io_camera_window *window, rlf_camera *camera);

#endif
