/* A camera's pixels: their rays, and which of them sees a point. */
#ifndef RLF_CAMERA_PIXELS_H
#define RLF_CAMERA_PIXELS_H

#include "relief/camera.h"

#include <string.h>

/* The same camera without its distortion. */
static inline rlf_camera camera_pinhole(const rlf_camera *camera)
{
    rlf_camera pinhole = *camera;
    pinhole.distortion_model = RLF_DISTORTION_NONE;
    memset(pinhole.distortion, 0, sizeof(pinhole.distortion));
    return pinhole;
}

/* The ray of each pixel at z = 1, two planes; 0, 0 where the lens has none. */
void camera_fill_rays(const rlf_camera *camera, float *ray_x, float *ray_y);

/* Index of the pixel that sees a point of the camera's frame; -1 = none. */
static inline int32_t camera_pixel_of(const rlf_camera *camera, rlf_vec3 p)
{
    double u, v;
    if (!rlf_camera_project(camera, p, &u, &v) || !(u > -0.5 && v > -0.5) ||
        !(u < camera->width - 0.5 && v < camera->height - 0.5)) {
        return -1;
    }
    return (int32_t)(v + 0.5) * camera->width + (int32_t)(u + 0.5);
}

#endif
