/* Whether times can be subtracted from each other. */
#ifndef RLF_BASE_TIME_RANGE_H
#define RLF_BASE_TIME_RANGE_H

#include "relief/frame.h"

static inline bool time_is_usable(int64_t time_ns)
{
    return time_ns >= -RLF_TIME_MAX_NS && time_ns <= RLF_TIME_MAX_NS;
}

/* Fails with one line that names the frame and the time that is not. */
static inline rlf_result check_times(const char *who, const rlf_frame *frame)
{
    const int64_t times[3] = {frame->time_ns, frame->color_time_ns, frame->host_time_ns};
    for (int i = 0; i < 3; i++) {
        if (!time_is_usable(times[i])) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: frame %llu: %s is %lld ns, more than 146 years: use nanoseconds "
                            "from any nearer origin",
                            who, (unsigned long long)frame->sequence,
                            i == 0   ? "time_ns"
                            : i == 1 ? "color_time_ns"
                                     : "host_time_ns",
                            (long long)times[i]);
        }
    }
    return RLF_OK;
}

#endif
