/* One answer to "is this one surface, or a depth step?".
 *
 * Along one surface, depth changes for two reasons. The sensor's noise sigma(z) moves each sample.
 * The surface's slant moves depth by slope * z * footprint from one pixel to the next: little where
 * it faces the camera, much where it is grazed. What changes by more than both is a depth step.
 *
 * On a plane inverse depth is linear in the ray (x, y, 1): of n . p = d it is n . ray / d. So depth
 * changes per unit of ray by the share |(n_x, n_y)| / |n . ray| of itself, exactly when that share
 * is taken of the farther sample. All lengths are metres. Kernels take the tolerance's parts as
 * arguments. */
#ifndef RLF_SURFACE_DEPTH_STEP_H
#define RLF_SURFACE_DEPTH_STEP_H

#include "kernel/kernel.h"

/* Of the difference of two samples. Noise alone is beyond it in one pair of 500 million; mixed
 * pixels and speckle, which sigma(z) leaves out, are why it is not less. */
#define DEPTH_STEP_SIGMAS 6.0f
/* The same of a difference, in sigmas of one sample: times the square root of 2. */
#define DEPTH_STEP_DIFFERENCE (DEPTH_STEP_SIGMAS * 1.4142136f)
/* tan of 80 degrees: steeper surfaces return too little to be seen as one. It stands for a slope
 * that nobody knows. */
#define DEPTH_STEP_STEEPEST 5.67f

/* What a sensor makes of one surface. */
typedef struct depth_step {
    rlf_kernel_noise noise;
    float footprint; /* of a pixel at 1 m: 1 / focal length in pixels */
} depth_step;

static inline depth_step depth_step_make(const rlf_depth_noise *noise, double focal_px)
{
    return (depth_step){rlf_kernel_noise_make(noise), (float)(1.0 / focal_px)};
}

/* Share by which the depth of a plane changes per unit of ray; at most the steepest, which it is
 * for a missing normal (0). */
RLF_KERNEL_PART float depth_step_slope(float nx, float ny, float nz, float ray_x, float ray_y)
{
    float along = rlf_kernel_abs(nx * ray_x + ny * ray_y + nz), square = nx * nx + ny * ny;
    const float most = DEPTH_STEP_STEEPEST;
    bool is_steep = !(square < most * most * (along * along));
    return is_steep ? most : sqrtf(square) / along;
}

/* Most that two samples of one surface differ, `pixels` apart, the farther one at z; 0 apart is the
 * same ray seen twice. */
RLF_KERNEL_PART float depth_step_most(const depth_step *s, float z, float slope, float pixels)
{
    return DEPTH_STEP_DIFFERENCE * rlf_kernel_sigma(s->noise, z) +
           slope * pixels * s->footprint * z;
}

/* Whether there is a depth step between two samples of surfaces of at most that slope. */
RLF_KERNEL_PART bool depth_step_is(const depth_step *s, float a, float b, float slope, float pixels)
{
    float farther = a > b ? a : b;
    return rlf_kernel_abs(a - b) > depth_step_most(s, farther, slope, pixels);
}

/* The same of neighbours whose slope nobody knows. */
RLF_KERNEL_PART bool depth_step_between(const depth_step *s, float a, float b)
{
    return depth_step_is(s, a, b, DEPTH_STEP_STEEPEST, 1.0f);
}

/* The same of one ray at two times, or of what is seen and what was expected there. */
RLF_KERNEL_PART bool depth_step_since(const depth_step *s, float a, float b)
{
    return depth_step_is(s, a, b, 0.0f, 0.0f);
}

#endif
