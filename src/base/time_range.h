/* Whether times can be subtracted from each other. */
#ifndef RLF_BASE_TIME_RANGE_H
#define RLF_BASE_TIME_RANGE_H

#include "relief/base.h"

static inline bool time_is_usable(int64_t time_ns)
{
    return time_ns >= -RLF_TIME_MAX_NS && time_ns <= RLF_TIME_MAX_NS;
}

/* A frame's time_ns, color_time_ns and host_time_ns. Fails with one line that names the frame and
 * the time that is not usable. */
static inline rlf_result check_times(const char *who, uint64_t sequence, const int64_t times[3])
{
    static const char *const names[3] = {"time_ns", "color_time_ns", "host_time_ns"};
    for (int i = 0; i < 3; i++) {
        if (!time_is_usable(times[i])) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "%s: frame %llu: %s is %lld ns, more than 146 years: use nanoseconds "
                            "from any nearer origin",
                            who, (unsigned long long)sequence, names[i], (long long)times[i]);
        }
    }
    return RLF_OK;
}

#endif
