/* Pairs of depth and colour pictures by their times. */
#include "io/clip/clip.h"

#include <stdlib.h>

#define SHOTS_MAX (8 << 20) /* three days at 30 a second */

bool io_time_is_usable(int64_t time_ns)
{
    return time_ns >= -RLF_TIME_MAX_NS && time_ns <= RLF_TIME_MAX_NS;
}

int32_t io_time_nearest(const io_times *times, int64_t time_ns, int64_t max_gap_ns)
{
    /* First time at or after time_ns. */
    int32_t low = 0;
    int32_t high = times->count;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (io_time_at(times, middle) < time_ns) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    int64_t after = low < times->count ? io_time_at(times, low) - time_ns : INT64_MAX;
    int64_t before = low > 0 ? time_ns - io_time_at(times, low - 1) : INT64_MAX;
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

rlf_result io_time_interval(const io_times *times, int64_t *out_ns)
{
    const int32_t count = times->count - 1;
    *out_ns = 0;
    if (count < 1) {
        return RLF_OK;
    }
    int64_t *gaps = rlf_alloc_array((size_t)count, sizeof(gaps[0]));
    if (gaps == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t i = 0; i < count; i++) {
        gaps[i] = io_time_at(times, i + 1) - io_time_at(times, i);
    }
    qsort(gaps, (size_t)count, sizeof(gaps[0]), compare_times);
    *out_ns = gaps[count / 2];
    rlf_free(gaps);
    return RLF_OK;
}

int64_t io_time_lost(int64_t gap_ns, int64_t interval_ns)
{
    if (interval_ns <= 0 || gap_ns - interval_ns <= interval_ns / 2) {
        return 0;
    }
    return (gap_ns - interval_ns / 2) / interval_ns;
}

rlf_result io_shots_add(io_shots *shots, const char *file, io_shot shot)
{
    if (shots->count >= SHOTS_MAX) {
        return rlf_fail(RLF_ERROR_CAPACITY, "%s: holds more than %d pictures: cut it", file,
                        SHOTS_MAX);
    }
    rlf_result result = io_list_grow((void **)(void *)&shots->items, shots->count, 1, &shots->room,
                                     sizeof(shots->items[0]));
    if (result == RLF_OK) {
        shots->items[shots->count++] = shot;
    }
    return result;
}

static int compare_shots(const void *a, const void *b)
{
    const io_shot *x = a;
    const io_shot *y = b;
    if (x->time_ns != y->time_ns) {
        return x->time_ns < y->time_ns ? -1 : 1;
    }
    return (x->position > y->position) - (x->position < y->position);
}

bool io_shots_sort(io_shots *shots)
{
    for (int32_t i = 1; i < shots->count; i++) {
        if (compare_shots(&shots->items[i - 1], &shots->items[i]) > 0) {
            qsort(shots->items, (size_t)shots->count, sizeof(shots->items[0]), compare_shots);
            return true;
        }
    }
    return false;
}

io_times io_shots_times(const io_shots *shots)
{
    return (io_times){shots->items, sizeof(shots->items[0]), shots->count};
}

void io_shots_free(io_shots *shots)
{
    rlf_free(shots->items);
    *shots = (io_shots){0};
}
