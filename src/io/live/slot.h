/* Room for one frame of a camera, kept while its driver goes on. */
#ifndef RLF_IO_LIVE_SLOT_H
#define RLF_IO_LIVE_SLOT_H

#include "relief/frame.h"

typedef struct live_slot {
    rlf_frame frame; /* its planes are the slot's */
    void *depth;     /* of either kind */
    uint8_t *color, *confidence;
} live_slot;

rlf_result live_slot_create(const rlf_rig *rig, live_slot *out);
void live_slot_destroy(live_slot *slot);

/* A frame that rlf_frame_check allows. */
void live_slot_copy(live_slot *slot, const rlf_rig *rig, const rlf_frame *frame);

#endif
