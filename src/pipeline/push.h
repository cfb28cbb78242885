/* Frames that are pushed: a source with room for one frame. */
#ifndef RLF_PIPELINE_PUSH_H
#define RLF_PIPELINE_PUSH_H

#include "relief/source.h"

typedef struct pushed_frame {
    rlf_source *source; /* gives `frame` once; NULL = the pipeline has a source of the caller's */
    rlf_frame frame;
    bool is_full;
} pushed_frame;

/* `slot` stays where it is until pushed_frame_close. */
rlf_result pushed_frame_open(pushed_frame *slot, const rlf_rig *rig);
/* The next frame; NULL = none. */
void pushed_frame_put(pushed_frame *slot, const rlf_frame *frame);
void pushed_frame_close(pushed_frame *slot);

#endif
