/* Takes a sensor's constant depth offset away. */
#ifndef RLF_CAPTURE_DEPTH_OFFSET_H
#define RLF_CAPTURE_DEPTH_OFFSET_H

#include "relief/frame.h"

/* Bytes that `plane` needs; 0 when the rig has no offset. */
size_t depth_offset_size(const rlf_rig *rig);
/* Writes the frame's depth without the offset into `plane` and points the frame to it. What would
 * come out at 0 or less is missing. */
void depth_offset_take(const rlf_rig *rig, void *plane, rlf_frame *frame);

#endif
