/* What all live cameras need: their modes, the user's calibration, and counts of what was lost. */
#ifndef RLF_IO_DRIVER_LIVE_H
#define RLF_IO_DRIVER_LIVE_H

#include "relief/backend.h"

/* How long a live source's `next` waits before it says RLF_NO_FRAME. */
#define IO_LIVE_WAIT_MS 100

/* A picture's size and rate as a user asks for it; 0 = any. */
typedef struct io_mode {
    int32_t width, height;
    int32_t frames_per_second;
} io_mode;

/* Value of `key` as WIDTHxHEIGHT@RATE or WIDTHxHEIGHT; *out is left alone when it was not given. */
rlf_result io_mode_get(const rlf_address *address, const char *key, io_mode *out);

/* Puts the user's calibration (?camera=FILE) in place of the device's; an error when its pictures
 * have another size. */
rlf_result io_live_use_rig(const rlf_address *address, rlf_rig *rig);

/* A driver's transform: nine numbers of a rotation, row by row, and a translation in units of
 * `metres`. False when it is no rotation. */
bool io_live_pose(const float rotation[9], const float translation[3], double metres,
                  rlf_pose *out);

/* Order of the frames of one device. Zero before the first. */
typedef struct io_live_count {
    bool has_last;
    uint64_t number;     /* the device's, of the last frame */
    int64_t time_ns;     /* the device's, of the last frame */
    int64_t offset_ns;   /* from the device's time to what is told, which never goes back */
    int64_t interval_ns; /* nominal; set by the caller */
    bool is_restarted;   /* set by the caller: the next frame's time is of another clock */
    uint64_t sequence;
    uint64_t lost, doubled;
} io_live_count;

/* A device's microseconds in nanoseconds; 0 for more than RLF_TIME_MAX_NS. */
int64_t io_live_time(uint64_t microseconds);

/* Sets sequence, time_ns and the flag of a discontinuity of *out from the device's count and time.
 * False when the frame is the last one again: it must not be given. A count or a time that goes
 * back is a device that started anew. */
bool io_live_count_frame(io_live_count *c, uint64_t number, int64_t time_ns, rlf_frame *out);

/* For devices without a count: told from the gap of two times and the nominal interval. */
bool io_live_count_time(io_live_count *c, int64_t time_ns, rlf_frame *out);

#endif
