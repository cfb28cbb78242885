/* A rectangle of pixels, and the one that a ball is seen in. */
#ifndef RLF_CAMERA_PIXEL_RECT_H
#define RLF_CAMERA_PIXEL_RECT_H

#include "base/inside.h"
#include "relief/camera.h"

/* Pixels x0 <= x < x1, y0 <= y < y1. */
typedef struct pixel_rect {
    int32_t x0, y0, x1, y1;
} pixel_rect;

/* Where a ball in the camera's frame may be seen; false when it is not in the picture. */
bool pixel_rect_of_ball(const rlf_camera *camera, rlf_vec3 center, double radius, pixel_rect *out)
    RLF_INSIDE(pixel_rect_of_ball);

#endif
