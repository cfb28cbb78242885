/* Times and counts of a camera's frames, kept going when its own clock or counter starts anew. */
#ifndef RLF_IO_LIVE_FOLLOW_H
#define RLF_IO_LIVE_FOLLOW_H

#include "relief/frame.h"

typedef struct live_follow {
    bool has_last, is_connection_new;
    uint64_t device_sequence; /* of the last frame, as the device said */
    int64_t device_time_ns;
    int64_t host_ns;   /* when it came */
    uint64_t sequence; /* of the last frame, as given on */
    int64_t time_ns;
} live_follow;

/* The next frame comes from a device that was opened again. */
void live_follow_reconnect(live_follow *follow);

/* Sets the frame's count and times so that both go on from the last frame. False for a frame that
 * came twice. *out_lost: frames that the device made since the last one and nobody got. */
bool live_follow_frame(live_follow *follow, int64_t host_ns, rlf_frame *frame, uint64_t *out_lost);

#endif
