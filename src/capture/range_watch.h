/* Whether the first frame that has depth has it where the sensor measures. */
#ifndef RLF_CAPTURE_RANGE_WATCH_H
#define RLF_CAPTURE_RANGE_WATCH_H

#include "relief/source.h"

typedef struct range_watch {
    double min_m, max_m;
    bool is_done;
} range_watch;

/* Looks at a frame until one has depth. One warning where most of that is out of the range: then
 * its unit is wrong. */
void range_watch_see(range_watch *watch, const char *name, const rlf_frame *frame);

#endif
