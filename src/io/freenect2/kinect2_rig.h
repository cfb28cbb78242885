/* Kinect v2: the factory's calibration as Relief's cameras. */
#ifndef RLF_IO_FREENECT2_KINECT2_RIG_H
#define RLF_IO_FREENECT2_KINECT2_RIG_H

#include "io/freenect2/registration.h"
#include "relief/frame.h"

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

/* The camera of the undistorted picture of kinect2_registration_apply, without its mirroring: its
 * points are those of kinect2_point. */
rlf_camera kinect2_undistorted_camera(const kinect2_ir *ir);

#endif
