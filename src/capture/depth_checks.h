/* Whether depth is where the sensor measures, and the offset that is taken from it. */
#ifndef RLF_CAPTURE_DEPTH_CHECKS_H
#define RLF_CAPTURE_DEPTH_CHECKS_H

#include "relief/frame.h"
#include "relief/source.h"

/* ---- depth_offset.c: takes a sensor's constant depth offset away. */

/* Bytes that `plane` needs; 0 when the rig has no offset. */
size_t depth_offset_size(const rlf_rig *rig);
/* Writes the frame's depth without the offset into `plane` and points the frame to it. What would
 * come out at 0 or less is missing. */
void depth_offset_take(const rlf_rig *rig, void *plane, rlf_frame *frame);

/* ---- range_watch.c: whether the first frame that has depth has it where the sensor measures. */

typedef struct range_watch {
    double min_m, max_m;
    bool is_done;
} range_watch;

/* Looks at a frame until one has depth. One warning where most of that is out of the range: then
 * its unit is wrong. */
void range_watch_see(range_watch *watch, const char *name, const rlf_frame *frame);

#endif
