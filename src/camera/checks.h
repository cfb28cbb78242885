/* Whether what comes from a caller or a driver can be used: looked at once, where it enters. All
 * return RLF_OK, or RLF_ERROR_INVALID with a line that names `who` and the field. */
#ifndef RLF_CAMERA_CHECKS_H
#define RLF_CAMERA_CHECKS_H

#include "relief/frame.h"

/* Place and quaternion are finite. */
rlf_result pose_check(const rlf_pose *T, const char *who, const char *field);
/* The cameras that it has, their transform, range and noise. */
rlf_result rig_check(const rlf_rig *rig, const char *who);
/* frame_check.c: size and stride of its colour picture, if it has one. */
rlf_result color_check(const rlf_frame *frame, const char *who);

#endif
