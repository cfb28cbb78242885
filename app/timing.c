/* Order statistics of the newest samples. */
#include "timing.h"

#include <stdlib.h>
#include <string.h>

void timing_add(timing_series *series, double value)
{
    series->samples[series->count % TIMING_SAMPLES_MAX] = value;
    series->count++;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

double timing_percentile(const timing_series *series, double percent)
{
    size_t count =
        (size_t)(series->count < TIMING_SAMPLES_MAX ? series->count : TIMING_SAMPLES_MAX);
    if (count == 0) {
        return 0.0;
    }
    double *sorted = malloc(count * sizeof(double));
    if (sorted == NULL) {
        return 0.0;
    }
    memcpy(sorted, series->samples, count * sizeof(double));
    qsort(sorted, count, sizeof(double), compare_doubles);
    size_t rank = (size_t)(percent / 100.0 * (double)(count - 1) + 0.5);
    double value = sorted[rank];
    free(sorted);
    return value;
}

void timing_add_frame(timing *t, const rlf_stage_times *stages, double frame_ms)
{
    timing_add(&t->capture, stages->capture_ms);
    timing_add(&t->surface, stages->surface_ms);
    timing_add(&t->physics, stages->physics_ms);
    timing_add(&t->render, stages->render_ms);
    timing_add(&t->frame, frame_ms);
}
