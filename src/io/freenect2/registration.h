/* Kinect v2: what libfreenect2's Registration computes, bit for bit (libfreenect2 0.2.1, commit
 * fd64c5d), written anew from its formulas. All pictures are as the camera gives them: mirrored. */
#ifndef RLF_IO_FREENECT2_REGISTRATION_H
#define RLF_IO_FREENECT2_REGISTRATION_H

#include "relief/base.h"

#define KINECT2_DEPTH_WIDTH 512
#define KINECT2_DEPTH_HEIGHT 424
#define KINECT2_DEPTH_PIXELS (KINECT2_DEPTH_WIDTH * KINECT2_DEPTH_HEIGHT)
#define KINECT2_COLOR_WIDTH 1920
#define KINECT2_COLOR_HEIGHT 1080
#define KINECT2_COLOR_PIXELS (KINECT2_COLOR_WIDTH * KINECT2_COLOR_HEIGHT)
/* One row more above and below, so that a window never leaves the picture. */
#define KINECT2_BIG_HEIGHT (KINECT2_COLOR_HEIGHT + 2)

/* Infrared camera: pixels, and the coefficients of plumb_bob. */
typedef struct kinect2_ir {
    float fx, fy, cx, cy, k1, k2, k3, p1, p2;
} kinect2_ir;

/* Colour camera. mx and my are the coefficients of x^3 y^3 x^2y xy^2 x^2 y^2 xy x y 1. shift_m is
 * the baseline in millimetres. */
typedef struct kinect2_color {
    float fx, fy, cx, cy, shift_d, shift_m;
    float mx[10], my[10];
} kinect2_color;

/* Thread-safety: one call at a time per object. */
typedef struct kinect2_registration kinect2_registration;

rlf_result kinect2_registration_create(const kinect2_ir *ir, const kinect2_color *color,
                                       kinect2_registration **out);
void kinect2_registration_destroy(kinect2_registration **registration);

/* What apply writes, KINECT2_DEPTH_PIXELS each. Depth in millimetres. */
typedef struct kinect2_registered {
    float *undistorted; /* nearest pixel of the lens-distorted picture; outside it 0 */
    uint32_t *color;    /* of the colour camera; 0 = outside, without depth, or hidden from it */
    int32_t *offset;    /* of that colour pixel; -1 = none */
} kinect2_registered;

/* `color` has KINECT2_COLOR_PIXELS pixels of any 4-byte format. */
void kinect2_registration_apply(kinect2_registration *registration, const float *depth,
                                const uint32_t *color, const kinect2_registered *out);

/* Nearest depth, millimetres, in a window of 5 x 3 round each colour pixel, as the last apply found
 * it; infinite = none. KINECT2_COLOR_WIDTH x KINECT2_BIG_HEIGHT; valid until the next apply. */
const float *kinect2_registration_big_depth(const kinect2_registration *registration);

/* Where pixel (u, v) of the undistorted picture at z millimetres is in the colour picture. */
void kinect2_project(const kinect2_ir *ir, const kinect2_color *color, float u, float v, float z,
                     float out[2]);

/* Point in metres of pixel (u, v) of the undistorted picture; NaN when depth is missing. */
void kinect2_point(const kinect2_ir *ir, int u, int v, float depth_mm, float out[3]);

#endif
