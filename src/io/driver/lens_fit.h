/* A lens that is known only by where it puts rays, as Relief's plumb_bob model. */
#ifndef RLF_IO_DRIVER_LENS_FIT_H
#define RLF_IO_DRIVER_LENS_FIT_H

#include "relief/camera.h"

typedef struct io_lens_sample {
    double x, y; /* ray (x, y, 1) */
    double u, v; /* its pixel */
} io_lens_sample;

/* Sets the camera's distortion to the k1 k2 p1 p2 k3 that fit best; fx, fy, cx, cy are given.
 * Returns the largest distance that is left, pixels; infinity when nothing fits, and then the
 * camera is left without distortion. */
double io_lens_fit(const io_lens_sample *samples, int32_t count, rlf_camera *camera);

#endif
