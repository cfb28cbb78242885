/* Refusals, each with what to do about it. */
#include "calibrate/solve.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FOCAL_DEVIATION_MAX 0.02 /* of the focal length */
#define BOX_LEAST 0.25           /* of the picture's area that all corners together span */
#define TILT_LEAST_DEG 15.0 /* less perspective than this leaves focal length and distance one */
#define SIGMA_LEAST_PX 0.1  /* corners are not found better than this */
#define RMS_GOOD_PX 0.5
#define RMS_MAX_SHARE 0.004 /* of the picture's width: the corners fit no board */
#define DEGREES 57.29577951308232

static const char *ninth_name(int row, int column)
{
    static const char *const names[3][3] = {{"upper left", "top", "upper right"},
                                            {"left", "middle", "right"},
                                            {"lower left", "bottom", "lower right"}};
    return names[row][column];
}

static void name_missing(const bool seen[3][3], char *out, size_t size)
{
    out[0] = '\0';
    for (int i = 0; i < 9; i++) {
        if (!seen[i / 3][i % 3]) {
            const size_t length = strlen(out);
            snprintf(out + length, size - length, "%s%s", length > 0 ? ", " : "",
                     ninth_name(i / 3, i % 3));
        }
    }
}

void calibrate_cover(const calibrate_views *views, int32_t camera, calibrate_coverage *out)
{
    bool ninths[3][3] = {{false}};
    *out = (calibrate_coverage){.box = {1.0, 1.0, 0.0, 0.0}};
    for (int32_t i = 0; i < views->count; i++) {
        const calibrate_sight *sight = &views->views[i].sight[camera];
        for (int32_t k = 0; views->views[i].is_used && k < sight->count; k++) {
            const double x =
                rlf_clamp((sight->points[k].u + 0.5) / views->width[camera], 0, 0.9999);
            const double y =
                rlf_clamp((sight->points[k].v + 0.5) / views->height[camera], 0, 0.9999);
            out->cells[(int)(y * COVERAGE_ROWS)][(int)(x * COVERAGE_COLUMNS)] = true;
            ninths[(int)(y * 3)][(int)(x * 3)] = true;
            out->box[0] = rlf_min(out->box[0], x);
            out->box[1] = rlf_min(out->box[1], y);
            out->box[2] = rlf_max(out->box[2], x);
            out->box[3] = rlf_max(out->box[3], y);
        }
    }
    for (int i = 0; i < COVERAGE_ROWS * COVERAGE_COLUMNS; i++) {
        out->share += out->cells[i / COVERAGE_COLUMNS][i % COVERAGE_COLUMNS];
    }
    out->share /= COVERAGE_ROWS * COVERAGE_COLUMNS;
    name_missing((const bool(*)[3])ninths, out->missing, sizeof(out->missing));
}

double calibrate_tilt_spread(const calibrate_views *views)
{
    double least = 1.0;
    for (int32_t i = 0; i < views->count; i++) {
        for (int32_t k = 0; k < i; k++) {
            if (views->views[i].is_used && views->views[k].is_used) {
                const rlf_vec3 axis = rlf_vec3_make(0, 0, 1);
                const rlf_vec3 a = rlf_rotate(views->views[i].T_first_board.q, axis);
                const rlf_vec3 b = rlf_rotate(views->views[k].T_first_board.q, axis);
                least = rlf_min(least, rlf_dot(a, b));
            }
        }
    }
    return DEGREES * rlf_acos(rlf_clamp(least, -1.0, 1.0));
}

rlf_result calibrate_judge_views(const calibrate_views *views, const calibrate_model *model)
{
    for (int32_t c = 0; c < views->camera_count; c++) {
        const int32_t used = calibrate_views_used(views, c);
        if (!model->is_fixed[CALIBRATE_LENS * c] && used < CALIBRATE_VIEWS_LEAST) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "too few views: %d different pictures of the %s camera show the whole "
                            "board, and %d are needed; 15 to 20 are good",
                            (int)used, views->camera_name[c], CALIBRATE_VIEWS_LEAST);
        }
    }
    return RLF_OK;
}

/* Focal length's standard deviation as a share of it; corners are not believed to be better than
 * SIGMA_LEAST_PX. */
static double focal_deviation(const calibrate_model *model, const calibrate_fit *fit, int32_t c)
{
    const double trust = rlf_max(1.0, SIGMA_LEAST_PX / rlf_max(fit->sigma, 1e-9));
    return trust * rlf_max(calibrate_deviation(fit, CALIBRATE_LENS * c) / model->camera[c].fx,
                           calibrate_deviation(fit, CALIBRATE_LENS * c + 1) / model->camera[c].fy);
}

static rlf_result judge_camera(const calibrate_views *views, const calibrate_model *model,
                               const calibrate_fit *fit, int32_t c)
{
    const char *name = views->camera_name[c];
    calibrate_coverage cover;
    calibrate_cover(views, c, &cover);
    const double box = (cover.box[2] - cover.box[0]) * (cover.box[3] - cover.box[1]);
    if (box < BOX_LEAST) {
        const int row = (int)(1.5 * (cover.box[1] + cover.box[3]));
        const int column = (int)(1.5 * (cover.box[0] + cover.box[2]));
        return rlf_fail(RLF_ERROR_INVALID,
                        "the board was only in one part of the %s camera's picture (%s, %.0f %% of "
                        "it): the lens elsewhere is unknown. Move the board through all of the "
                        "picture, to its edges and corners",
                        name, ninth_name(row, column), 100.0 * box);
    }
    const double deviation = focal_deviation(model, fit, c);
    if (!(deviation <= FOCAL_DEVIATION_MAX)) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "the views leave the %s camera's focal length open by %.1f %%: add views, "
                        "nearer, and tilted by 20 to 40 degrees to all sides",
                        name, 100.0 * deviation);
    }
    if (fit->rms_of[c] > RMS_GOOD_PX) {
        rlf_log(RLF_LOG_WARNING,
                "corners of the %s camera are %.2f px off, where sharp pictures of a flat board "
                "give 0.1 to 0.3",
                name, fit->rms_of[c]);
    }
    if (cover.missing[0] != '\0') {
        rlf_log(RLF_LOG_WARNING, "the board was never in this part of the %s camera's picture: %s",
                name, cover.missing);
    }
    return RLF_OK;
}

rlf_result calibrate_judge_fit(const calibrate_views *views, const calibrate_model *model,
                               const calibrate_fit *fit)
{
    const double tilt = calibrate_tilt_spread(views);
    const bool is_open = !fit->is_determined || !rlf_is_finite(fit->sigma);
    if (tilt < TILT_LEAST_DEG) {
        return rlf_fail(RLF_ERROR_INVALID,
                        "flat poses: all boards face the same way to %.0f degrees, so focal length "
                        "and distance cannot be told apart. Tilt the board by 20 to 40 degrees to "
                        "the left, to the right, up and down",
                        tilt);
    }
    for (int32_t c = 0; c < views->camera_count; c++) {
        const double limit = rlf_max(1.0, RMS_MAX_SHARE * views->width[c]);
        if (fit->rms_of[c] > limit) {
            return rlf_fail(RLF_ERROR_INVALID,
                            "the corners fit no rigid %dx%d board: %.1f pixels off in the %s "
                            "camera's pictures. Is --board right, is the board flat, are the "
                            "pictures of one camera and not mirrored or rescaled?",
                            (int)views->board.columns, (int)views->board.rows, fit->rms_of[c],
                            views->camera_name[c]);
        }
    }
    for (int32_t c = 0; c < views->camera_count && !is_open; c++) {
        if (model->is_fixed[CALIBRATE_LENS * c]) {
            continue;
        }
        rlf_result result = judge_camera(views, model, fit, c);
        if (result != RLF_OK) {
            return result;
        }
    }
    return is_open ? rlf_fail(RLF_ERROR_INVALID,
                              "the views do not determine the cameras: add views from other sides")
                   : RLF_OK;
}
