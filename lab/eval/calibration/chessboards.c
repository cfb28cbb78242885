/* OpenCV's chessboards, as the field compares itself on them: all views, none left out. */
#include "eval/calibration/calibration.h"

#include "calibrate/calibrate.h"

#include <math.h>
#include <stdio.h>

#define SCENE "chessboards"
#define PATH_SIZE 4096

/* How far OpenCV's own optimum of the same corners is from ours: largest difference of a focal
 * length, pixels. */
static rlf_result compare(const calibration *c, double *out_px)
{
    const relief_opencv_api *api = opencv_get();
    calibrate_model theirs = c->model;
    double rms;
    rlf_result result = calibrate_opencv_stereo(api, &c->views, &theirs, &rms);
    *out_px = 0.0;
    for (int k = 0; k < CALIBRATE_CAMERAS && result == RLF_OK; k++) {
        *out_px = rlf_max(*out_px, fabs(theirs.camera[k].fx - c->model.camera[k].fx));
        *out_px = rlf_max(*out_px, fabs(theirs.camera[k].fy - c->model.camera[k].fy));
    }
    return result;
}

static void add(eval_table *table, const char *key, const char *title, double value)
{
    eval_table_add(table, SCENE, key, title, RLF_PROFILE_LIVE, value);
}

rlf_result eval_chessboards_run(eval_table *table, const char *folder)
{
    char left[PATH_SIZE], right[PATH_SIZE];
    snprintf(left, sizeof(left), "%.4000s/left*", folder);
    snprintf(right, sizeof(right), "%.4000s/right*", folder);
    const calibrate_options options = {.board = {.columns = 9, .rows = 6, .square_m = 0.025},
                                       .left = left,
                                       .right = right,
                                       .units_per_metre = 1000.0,
                                       .keeps_outliers = true};
    calibration c = {.offset_m = NAN};
    double apart = NAN;
    rlf_result result = calibrate_views_create(&options.board, &c.views);
    result = result == RLF_OK ? calibrate_folders(&options, &c) : result;
    result = result == RLF_OK ? compare(&c, &apart) : result;
    if (result == RLF_OK) {
        add(table, "pairs", "pairs of pictures in which the board was found",
            calibrate_views_used(&c.views, -1));
        add(table, "stereo_rms_px", "stereo RMS, all corners, px", c.fit.rms);
        add(table, "left_rms_px", "RMS of the left camera, px", c.fit.rms_of[0]);
        add(table, "right_rms_px", "RMS of the right camera, px", c.fit.rms_of[1]);
        add(table, "left_leave_one_out_px", "leave-one-view-out RMS, left, px", c.leave_one_out[0]);
        add(table, "right_leave_one_out_px", "leave-one-view-out RMS, right, px",
            c.leave_one_out[1]);
        add(table, "epipolar_px", "mean distance from the epipolar line, px", c.epipolar);
        add(table, "opencv_apart_px", "focal lengths, away from OpenCV's optimum, px", apart);
    }
    calibration_free(&c);
    return result;
}
