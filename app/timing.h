/* Collects per-frame numbers and tells their median and percentiles. */
#ifndef RELIEF_APP_TIMING_H
#define RELIEF_APP_TIMING_H

#include "relief/pipeline.h"

#define TIMING_SAMPLES_MAX 8192 /* the newest ones are kept */

typedef struct timing_series {
    double samples[TIMING_SAMPLES_MAX];
    int64_t count; /* ever added */
} timing_series;

/* Milliseconds per stage and of the whole loop. */
typedef struct timing {
    timing_series capture, surface, physics, render, frame;
} timing;

void timing_add(timing_series *series, double value);
/* Percentile 0..100 by nearest rank; 0 when there is no sample. */
double timing_percentile(const timing_series *series, double percent);
/* Adds one frame; frame_ms is the whole loop's wall time. */
void timing_add_frame(timing *t, const rlf_stage_times *stages, double frame_ms);

#endif
