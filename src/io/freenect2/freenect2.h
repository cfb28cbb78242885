/* One Kinect v2 that streams. */
#ifndef RLF_IO_FREENECT2_FREENECT2_H
#define RLF_IO_FREENECT2_FREENECT2_H

#include "io/live/driver.h"
#include "io/freenect2/freenect2_shim.h"
#include "relief/base.h"
#include "relief/frame.h"

#define KINECT2_DEPTH_WIDTH 512
#define KINECT2_DEPTH_HEIGHT 424
#define KINECT2_DEPTH_PIXELS (KINECT2_DEPTH_WIDTH * KINECT2_DEPTH_HEIGHT)
#define KINECT2_COLOR_WIDTH 1920
#define KINECT2_COLOR_HEIGHT 1080
#define KINECT2_COLOR_PIXELS (KINECT2_COLOR_WIDTH * KINECT2_COLOR_HEIGHT)

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

/* Where pixel (u, v) of the undistorted picture at z millimetres is in the colour picture. */
void kinect2_project(const kinect2_ir *ir, const kinect2_color *color, float u, float v, float z,
                     float out[2]);

typedef struct freenect2_api {
#define IO_FREENECT2_MEMBER(result, name, parameters) result(*name) parameters;
    RELIEF_FREENECT2_FUNCTIONS(IO_FREENECT2_MEMBER)
#undef IO_FREENECT2_MEMBER
} freenect2_api;

typedef struct freenect2 {
    const freenect2_api *api;
    char source[256];
    relief_freenect2 *device;
    kinect2_ir ir;
    kinect2_color factory;
    rlf_rig rig;
    float *depth; /* metres, not mirrored */
    rlf_image_rgba8 color;
    bool is_aligned; /* the next two are for this alone */
    float *undistorted;
    uint32_t *registered;
    io_live_count count;
    bool has_time;
    uint32_t time_last; /* the device's, of the last depth picture */
    int64_t time_ns;    /* alike, without wrapping */
    int64_t last_frame_ns;
} freenect2;

/* A rlf_source's `next`. */
rlf_result io_freenect2_next(void *self, rlf_frame *out);

/* ---- Kinect v2: the factory's calibration as Relief's cameras ---- */

/* How well a colour camera with a lens and a pose gives what the factory's cubics give, pixels of
 * the colour picture, over depths from 0.8 m to 4.5 m. */
typedef struct kinect2_fit {
    double rms_px, worst_px;
} kinect2_fit;

/* Cameras of the raw pictures without their mirroring. The depth camera is the factory's lens as it
 * is; the colour camera and its pose are fitted. RLF_ERROR_DEVICE when the numbers fit no camera.
 */
rlf_result kinect2_rig_fit(const kinect2_ir *ir, const kinect2_color *color, rlf_rig *out,
                           kinect2_fit *out_fit);

/* The camera of the undistorted picture of libfreenect2's Registration, without its mirroring. */
rlf_camera kinect2_undistorted_camera(const kinect2_ir *ir);

#endif
