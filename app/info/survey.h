/* What a source turns out to be when its frames are read. */
#ifndef RELIEF_APP_INFO_SURVEY_H
#define RELIEF_APP_INFO_SURVEY_H

#include "info/color_fit.h"
#include "info/missing.h"
#include "info/stillness.h"
#include "relief/source.h"

typedef struct survey_options {
    double seconds;      /* of a live source */
    int64_t frame_limit; /* of one that has no end; 0 = no limit */
} survey_options;

typedef struct survey {
    int64_t frames, with_color, with_pose, with_confidence, jumps;
    int64_t failed; /* could not be read; `first_error` says why the first of them */
    char first_error[512];
    double duration_s;                     /* from the first frame to the last */
    double interval_s, interval_longest_s; /* median; 0 = fewer than two frames */
    double color_gap_s;                    /* mean |colour time - depth time| */
    uint32_t flags;                        /* of any frame */
    rlf_source_status status;
    missing_counts missing;
    stillness_result stillness;
    bool has_fit;
    color_fit_result fit;
} survey;

/* Reads the source to its end or as far as the options say. */
rlf_result survey_run(rlf_source *source, const survey_options *options, survey *out);

#endif
