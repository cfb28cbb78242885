/* The outline of a board in a depth picture: the thesis's way to calibrate a depth camera that
 * gives no infrared pictures. */
#ifndef RELIEF_APP_CALIBRATE_OUTLINE_H
#define RELIEF_APP_CALIBRATE_OUTLINE_H

#include "relief/frame.h"

/* Looks for the four corners of a board of size[0] x size[1] metres, which is near T_camera_board,
 * in `depth` (metres, 0 = missing, rig->depth's size). Each side is a line through the places where
 * the board's plane ends. out: left top, right top, left bottom, right bottom, as pixels of a
 * camera with the same f and c and no distortion; out_sigma: how far the places are from their
 * lines, pixels. False when a side is not to be seen. */
bool calibrate_outline(const rlf_rig *rig, const rlf_pose *T_camera_board, const double size[2],
                       const float *depth, double out[4][2], double *out_sigma);

#endif
