/* Depth out of the sensor's range, mostly: a wrong unit, in all likelihood. */
#include "capture/depth_checks.h"

#include <stddef.h>
#include <stdio.h>

enum {
    LEAST_SHARE = 100, /* of the pixels one of so many must have depth */
    CELLS = 4096       /* of a histogram of depth, for the median */
};

/* Each cell is 1 % farther than the one before: 1e-5 m to 1e12 m. */
#define FIRST_M 1e-5
#define FARTHER 1.01

typedef struct tally {
    int64_t pixels, seen, within;
    int64_t cells[CELLS];
} tally;

/* The cell whose end is the first above z. */
static int32_t cell_of(const double *ends, double z)
{
    int32_t low = 0, high = CELLS - 1;
    while (low < high) {
        const int32_t middle = (low + high) / 2;
        if (ends[middle] > z) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

static void add_row(const range_watch *watch, const double *ends, const rlf_frame *frame, int32_t y,
                    tally *sum)
{
    const ptrdiff_t skip = y * frame->depth_stride;
    const int32_t width = frame->rig->depth.width;
    const void *counts = (const char *)frame->depth_u16 + skip;
    const void *metres = (const char *)frame->depth_f32 + skip;
    for (int32_t x = 0; x < width; x++) {
        const double z = frame->depth_u16 != NULL
                             ? ((const uint16_t *)counts)[x] / frame->depth_units_per_metre
                             : (double)((const float *)metres)[x];
        const bool is_none = !(z > 0.0) || !rlf_is_finite(z) ||
                             (frame->depth_u16 != NULL && ((const uint16_t *)counts)[x] == 65535);
        sum->pixels++;
        if (!is_none) {
            sum->seen++;
            sum->within += z >= watch->min_m && z <= watch->max_m;
            sum->cells[cell_of(ends, z)]++;
        }
    }
}

static double median_of(const tally *sum, const double *ends)
{
    int64_t below = 0;
    int32_t i = 0;
    while (i < CELLS - 1 && 2 * (below + sum->cells[i]) < sum->seen) {
        below += sum->cells[i++];
    }
    return ends[i];
}

static void tell(const range_watch *watch, const char *name, const rlf_frame *frame,
                 const tally *sum, double median_m)
{
    const int percent = (int)(100 * sum->within / sum->seen);
    char share[64], unit[64] = "", median[32];
    (void)snprintf(median, sizeof(median), median_m < 99.5 ? "%.2g" : "%.0f", median_m);
    if (sum->within == 0) {
        (void)snprintf(share, sizeof(share), "no pixel is");
    } else {
        (void)snprintf(share, sizeof(share), "only %d %% of the pixels with depth are", percent);
    }
    if (frame->depth_u16 != NULL) {
        (void)snprintf(unit, sizeof(unit), " (it is %g)", frame->depth_units_per_metre);
    }
    rlf_log(RLF_LOG_WARNING,
            "%s: %s between %.2f and %.2f m, the median is %s m: is units_per_metre%s right? "
            "camera.json or SOURCE?camera=FILE sets it, and depth_min_m and depth_max_m",
            name, share, watch->min_m, watch->max_m, median, unit);
}

void range_watch_see(range_watch *watch, const char *name, const rlf_frame *frame)
{
    const bool has_depth = frame->depth_u16 != NULL || frame->depth_f32 != NULL;
    if (watch->is_done || !(watch->max_m > watch->min_m) || !has_depth) {
        return;
    }
    static const int32_t step = 2; /* every other row is enough */
    double ends[CELLS];
    ends[0] = FIRST_M;
    for (int32_t i = 1; i < CELLS; i++) {
        ends[i] = ends[i - 1] * FARTHER;
    }
    tally sum = {0};
    for (int32_t y = 0; y < frame->rig->depth.height; y += step) {
        add_row(watch, ends, frame, y, &sum);
    }
    if (LEAST_SHARE * sum.seen < sum.pixels) {
        return;
    }
    watch->is_done = true;
    if (2 * sum.within < sum.seen) {
        tell(watch, name, frame, &sum, median_of(&sum, ends));
    }
}
