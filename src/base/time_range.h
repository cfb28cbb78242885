/* Whether times can be subtracted from each other. */
#ifndef RLF_BASE_TIME_RANGE_H
#define RLF_BASE_TIME_RANGE_H

#include "relief/base.h"

static inline bool time_is_usable(int64_t time_ns)
{
    return time_ns >= -RLF_TIME_MAX_NS && time_ns <= RLF_TIME_MAX_NS;
}

#endif
