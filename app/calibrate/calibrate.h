/* `relief calibrate`: what is asked for, and what comes out. */
#ifndef RELIEF_APP_CALIBRATE_CALIBRATE_H
#define RELIEF_APP_CALIBRATE_CALIBRATE_H

#include "calibrate/find.h"
#include "calibrate/solve.h"
#include "relief/frame.h"

typedef struct calibrate_options {
    calibrate_board board;
    const char *left, *right; /* folders of pictures; NULL = a source */
    const char *depth;        /* folder of depth pictures that go with `left`; NULL = none */
    const char *source;       /* NULL = folders */
    bool prints_board, is_letter;
    const char *check;      /* source to check; NULL = none */
    const char *convert;    /* calibration file to write in another format; NULL = none */
    const char *out_path;   /* camera.json; NULL = only printed */
    int32_t format;         /* of out_path, rlf_rig_format; -1 = by its name */
    const char *report;     /* folder; NULL = none */
    double units_per_metre; /* of the depth pictures of folders */
    int32_t views;          /* of a source: enough */
    int32_t seconds;        /* of a camera: give up after; 0 = never */
    bool finds_depth_lens;  /* of a source: by the board's outline, else the source's is kept */
    bool keeps_outliers;
} calibrate_options;

/* Everything that is known when it is done. */
typedef struct calibration {
    calibrate_views views;
    calibrate_model model;
    calibrate_fit fit;
    double leave_one_out[CALIBRATE_CAMERAS]; /* pixels; NAN = not seen */
    double epipolar;    /* mean distance to the epipolar line, pixels; NAN = one camera */
    double mapping_p95; /* standard deviation of where depth lands in colour, 95 % of the
                           picture, pixels; NAN = one camera */
    double offset_m, offset_deviation_m; /* depth is too far by this much; NAN = not measured */
    int32_t offset_boards;
    double offset_before_m;          /* that the source has taken away already */
    double depth_min_m, depth_max_m; /* 0 = unknown */
    double units_per_metre;
    rlf_depth_noise noise;  /* all 0 = unknown */
    bool is_thesis_way;     /* the depth camera by the board's outline */
    calibrate_gray sample;  /* of a source: one view in colour and depth, for the report */
    float *sample_depth;    /* metres; NULL = a calibration of folders */
    calibrate_model before; /* of a source: as it was */
} calibration;

void calibration_free(calibration *c);

/* Solves, leaves outliers out and judges: RLF_ERROR_INVALID with the reason when the views cannot
 * determine the cameras. */
rlf_result calibrate_finish(const calibrate_options *options, calibration *c);
rlf_result calibrate_folders(const calibrate_options *options, calibration *c);
rlf_result calibrate_source(const calibrate_options *options, calibration *c);
rlf_result calibrate_camera_write(const calibrate_options *options, const calibration *c);
/* Reads options->convert, writes options->out_path. */
rlf_result calibrate_convert(const calibrate_options *options);
bool calibrate_take_format(const char *text, void *out_int32);
rlf_result calibrate_report(const calibrate_options *options, const calibration *c);
void calibrate_print(const calibration *c);
/* Only the views that are left out, and why. */
void calibrate_print_views(const calibrate_views *views);

#endif
