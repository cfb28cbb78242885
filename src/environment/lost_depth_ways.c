/* How far the next seen pixel is from each lost one, in eight directions. */
#include "environment/real_depth.h"

#include "kernel/kernel.h"

#include <string.h>

/* One row from the one before it, whose pixel x + dx is next; `before` NULL = there is none. */
RLF_KERNEL static void step_row(const uint8_t *restrict reason, const uint8_t *restrict before,
                                int32_t dx, int32_t width, uint8_t *restrict out)
{
    const int32_t first = dx < 0 ? 1 : 0;
    const int32_t last = dx > 0 ? width - 1 : width;
    for (int32_t x = first; x < last; x++) {
        const uint8_t more =
            (uint8_t)(before[x + dx] + (before[x + dx] < LOST_DEPTH_NOTHING ? 1 : 0));
        out[x] = reason[x] == RLF_REASON_OK ? 0 : more;
    }
    const int32_t edge = dx < 0 ? 0 : width - 1;
    if (dx != 0) {
        out[edge] = reason[edge] == RLF_REASON_OK ? 0 : LOST_DEPTH_NOTHING;
    }
}

static void step_first_row(const uint8_t *reason, int32_t width, uint8_t *out)
{
    for (int32_t x = 0; x < width; x++) {
        out[x] = reason[x] == RLF_REASON_OK ? 0 : LOST_DEPTH_NOTHING;
    }
}

/* Along the row, run by run of lost pixels. */
static void step_along(const uint8_t *reason, int32_t dx, int32_t width, uint8_t *out)
{
    memset(out, 0, (size_t)width);
    for (int32_t x = 0; (x = rlf_kernel_next_mark(reason, x, width)) < width;) {
        int32_t end = x;
        while (end < width && reason[end] != RLF_REASON_OK) {
            end++;
        }
        const bool is_open = dx < 0 ? x == 0 : end == width;
        for (int32_t k = x; k < end; k++) {
            const int32_t away = is_open ? LOST_DEPTH_NOTHING : (dx < 0 ? k - x + 1 : end - k);
            out[k] = (uint8_t)(away < LOST_DEPTH_NOTHING ? away : LOST_DEPTH_NOTHING);
        }
        x = end;
    }
}

typedef struct ways_job {
    lost_depth *l;
    const uint8_t *reason;
    int32_t begin, end; /* rows */
} ways_job;

/* From the border that a way begins at to the last row that is asked for. */
static void find_way(const ways_job *job, int32_t k)
{
    const lost_depth *l = job->l;
    const int32_t dx = lost_depth_way[k][0], dy = lost_depth_way[k][1];
    const int32_t first = dy == 0 ? job->begin : 0;
    const int32_t end = dy > 0 ? l->height - job->begin : job->end;
    const uint8_t *before = NULL;
    for (int32_t n = first; n < end; n++) {
        const ptrdiff_t row = (ptrdiff_t)(dy > 0 ? l->height - 1 - n : n) * l->width;
        uint8_t *out = l->away[k] + row;
        if (dy == 0) {
            step_along(job->reason + row, dx, l->width, out);
        } else if (before == NULL) {
            step_first_row(job->reason + row, l->width, out);
        } else {
            step_row(job->reason + row, before, dx, l->width, out);
        }
        before = out;
    }
}

static void find_some(void *context, int32_t begin, int32_t end, int32_t worker)
{
    (void)worker;
    for (int32_t k = begin; k < end; k++) {
        find_way(context, k);
    }
}

void lost_depth_find_ways(lost_depth *l, const uint8_t *reason, int32_t begin, int32_t end)
{
    ways_job job = {l, reason, begin, end};
    rlf_parallel_for(l->pool, LOST_DEPTH_WAYS, 1, find_some, &job);
}
