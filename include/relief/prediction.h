/* Relief: what a camera at a pose would see of the static room: the value that a map predicts, that
 * a tracker aligns the next frame with, and that tells foreground from room while the camera moves.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_PREDICTION_H
#define RELIEF_PREDICTION_H

#include "relief/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Planes of camera.width x camera.height without padding, index = y * width + x. Whoever predicts
 * owns them; they stay as they are until the next prediction from the same place. A pixel of which
 * nothing is known has depth 0, normal (0, 0, 0) and grey 0. There is no NaN.
 *
 * The value is plain data: threads may read it at the same time as long as nobody predicts into its
 * planes.
 *
 * Source: Newcombe et al. 2011, KinectFusion, section 3.4 (the surface prediction). */
typedef struct rlf_prediction {
    /* Without distortion: pixel (u, v) looks along ((u - cx) / fx, (v - cy) / fy, 1). */
    rlf_camera camera;
    /* Where it is predicted for: camera to world, metres. */
    rlf_pose T_world_camera;
    /* z in the camera frame, metres. */
    const float *depth;
    /* Unit normals in the camera frame, towards the camera. */
    const float *normal_x, *normal_y, *normal_z;
    /* Luma 0..255; NULL = nobody knows the room's colour. */
    const uint8_t *grey;
} rlf_prediction;

#ifdef __cplusplus
}
#endif
#endif
