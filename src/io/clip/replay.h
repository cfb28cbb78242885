/* How a recording is played: keys of a SOURCE that every back end of files understands. */
#ifndef RLF_IO_CLIP_REPLAY_H
#define RLF_IO_CLIP_REPLAY_H

#include "io/source/address.h"
#include "relief/backend.h"

#define IO_REPLAY_FILE_KEYS "loop speed start count drop seed aligned"
#define IO_REPLAY_LIVE_KEYS "aligned direct" /* of what cannot be played again */

typedef struct io_replay {
    bool is_wanted; /* at least one key of playing was given */
    bool is_direct; /* a camera without a thread of its own: every frame in turn */
    bool loop;
    double speed;    /* 1 = as recorded, 2 = twice as fast; 0 = as fast as it is asked */
    int64_t start;   /* first frame */
    int64_t count;   /* frames from there on; 0 = to the end */
    double drop;     /* share of the frames to lose, 0..1 */
    uint64_t seed;   /* of which ones */
    int32_t aligned; /* -1 = as the file says */
} io_replay;

/* Takes out the keys above but for those that the back end has as its own. */
rlf_result io_replay_take(io_address *parts, const rlf_backend *backend, io_replay *out);

/* Puts the playing around the parts of a source. On failure they are left as they were. */
rlf_result io_replay_wrap(const io_replay *replay, const char *source, rlf_opened *inout);

#endif
