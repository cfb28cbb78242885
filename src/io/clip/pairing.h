/* Pairs of depth and colour pictures by their times. */
#ifndef RLF_IO_CLIP_PAIRING_H
#define RLF_IO_CLIP_PAIRING_H

#include "relief/base.h"

/* Whether it lies within RLF_TIME_MAX_NS, so that any two times can be subtracted. */
bool io_time_is_usable(int64_t time_ns);

/* a + b, wrapped around: clocks of bad drivers may say anything. */
static inline int64_t io_time_sum(int64_t a_ns, int64_t b_ns)
{
    return (int64_t)((uint64_t)a_ns + (uint64_t)b_ns);
}

/* Index of the time nearest to time_ns (the earlier of two equally near), or -1 when there is none
 * or the nearest is more than max_gap_ns away. `times` does not decrease. */
int32_t io_time_nearest(const int64_t *times, int32_t count, int64_t time_ns, int64_t max_gap_ns);

/* Median interval, nanoseconds; 0 when there are fewer than two times. `scratch` has room for
 * count - 1. */
int64_t io_time_interval(const int64_t *times, int32_t count, int64_t *scratch);

/* How many frames are missing between two of them that are `gap_ns` apart: 0 up to one and a half
 * intervals. */
int64_t io_time_lost(int64_t gap_ns, int64_t interval_ns);

#endif
