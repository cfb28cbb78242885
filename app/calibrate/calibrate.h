/* `relief calibrate`: what is asked for, what comes out, and what is made of it. */
#ifndef RELIEF_APP_CALIBRATE_CALIBRATE_H
#define RELIEF_APP_CALIBRATE_CALIBRATE_H

#include "calibrate/solve.h"
#include "relief/frame.h"
#include "relief/reconstruct.h"

#include <stdio.h>

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

/* ---- outline.c: the outline of a board in a depth picture: the thesis's way to calibrate a depth
 * camera that gives no infrared pictures */

/* Looks for the four corners of a board of size[0] x size[1] metres, which is near T_camera_board,
 * in `depth` (metres, 0 = missing, rig->depth's size). Each side is a line through the places where
 * the board's plane ends. out: left top, right top, left bottom, right bottom, as pixels of a
 * camera with the same f and c and no distortion; out_sigma: how far the places are from their
 * lines, pixels. False when a side is not to be seen. */
bool calibrate_outline(const rlf_rig *rig, const rlf_pose *T_camera_board, const double size[2],
                       const float *depth, double out[4][2], double *out_sigma);

/* ---- depth_offset.c: the constant by which a camera measures too far, from boards whose pose is
 * known */

/* Median over the board's pixels of measured depth minus that of its plane, metres; NAN where less
 * than half of the lattice has depth or it is not all in the picture. `depth` is the first camera's
 * picture, metres, 0 = missing. */
double depth_offset_on(const calibrate_view *view, const calibrate_board *board,
                       const rlf_camera *camera, const float *depth);
/* Mean of the views' offsets and its standard deviation into the calibration. */
void depth_offset_combine(calibration *c);

/* ---- folder_depth.c: depth pictures that belong to the infrared pictures of a folder */

/* Reads the 16-bit PNG of each view, found by its number, and measures the depth offset. */
rlf_result calibrate_folder_depth(const calibrate_options *options, calibration *c);

/* ---- check.c: `relief calibrate --check`: does a calibration still hold, and how does the camera
 * stand */

#define CALIBRATE_STAND_BINS 400 /* 2 cm each: 8 m below the camera */

/* What frames say about up and about level faces; all 0 to begin with. */
typedef struct calibrate_stand {
    int32_t frames, sure;
    rlf_vec3 up; /* sum over the frames that are sure, or of guesses while none is */
    int64_t level, count[CALIBRATE_STAND_BINS];
    double below_m[CALIBRATE_STAND_BINS]; /* sums */
} calibrate_stand;

void calibrate_stand_add(calibrate_stand *s, const rlf_surface *surface);
/* How far the floor's plane is below the camera, metres; false = no floor is seen. */
bool calibrate_stand_floor(const calibrate_stand *s, double *out_below_m);

/* Measures a source and prints it. */
rlf_result calibrate_check(const char *name, bool *out_is_stale);
/* The same of a list of cameras (docs/several-cameras.md): whether the surfaces that they share lie
 * on each other. Writes the list with poses by the room to out_path; NULL = only prints. */
rlf_result calibrate_check_cameras(const char *list, const char *out_path, bool *out_is_off);

/* ---- board.c: a chessboard to print, and what a printed board's file says of it */

/* Inner corners and the side of a square. */
typedef struct board_size {
    int32_t columns, rows;
    double square_m; /* 0 = not said */
} board_size;

/* Writes a page with the board in its middle, a line about its size and a ruler of 100 mm: PDF, or
 * SVG where the path ends with .svg. On A4 or Letter, upright or across as it fits. */
rlf_result board_print(const char *path, const board_size *board, bool is_letter);
/* Finds what board_print wrote about the board. */
rlf_result board_read(const char *path, board_size *out);

/* ---- svg.c: plots of a calibration as SVG inside a page */

/* Where one camera's picture has corners; empty cells are shaded. */
void svg_coverage(FILE *out, const calibration *c, int camera);
/* Each corner's error as a line, many times as long; and all errors about one point. */
void svg_residuals(FILE *out, const calibration *c, int camera);
void svg_scatter(FILE *out, const calibration *c, int camera);
/* Which way the boards faced: the tilt of each in degrees to the right and down. */
void svg_tilts(FILE *out, const calibration *c);

/* ---- report_pictures.c: pictures of a calibration's report: before it and after it */

/* Writes DIR/before.png and DIR/after.png: of folders a pair as it is and rectified, with level
 * lines; of a source its colour picture with the edges of depth in red. *out_count: how many were
 * written, 0 or 2. */
rlf_result calibrate_report_pictures(const calibrate_options *options, const calibration *c,
                                     int *out_count);

#endif
