/* Pairs of depth and colour pictures by their times. */
#include "io/clip/clip.h"

#include <stdlib.h>

bool io_time_is_usable(int64_t time_ns)
{
    return time_ns >= -RLF_TIME_MAX_NS && time_ns <= RLF_TIME_MAX_NS;
}

int32_t io_time_nearest(const int64_t *times, int32_t count, int64_t time_ns, int64_t max_gap_ns)
{
    /* First time at or after time_ns. */
    int32_t low = 0;
    int32_t high = count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (times[middle] < time_ns) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    int64_t after = low < count ? times[low] - time_ns : INT64_MAX;
    int64_t before = low > 0 ? time_ns - times[low - 1] : INT64_MAX;
    int64_t gap = before <= after ? before : after;
    if (gap > max_gap_ns) {
        return -1;
    }
    return before <= after ? low - 1 : low;
}

static int compare_times(const void *a, const void *b)
{
    const int64_t *x = a;
    const int64_t *y = b;
    return (*x > *y) - (*x < *y);
}

int64_t io_time_interval(const int64_t *times, int32_t count, int64_t *scratch)
{
    if (count < 2) {
        return 0;
    }
    for (int32_t i = 0; i + 1 < count; i++) {
        scratch[i] = times[i + 1] - times[i];
    }
    qsort(scratch, (size_t)count - 1, sizeof(scratch[0]), compare_times);
    return scratch[(count - 1) / 2];
}

int64_t io_time_lost(int64_t gap_ns, int64_t interval_ns)
{
    if (interval_ns <= 0 || gap_ns - interval_ns <= interval_ns / 2) {
        return 0;
    }
    return (gap_ns - interval_ns / 2) / interval_ns;
}
