/* From views to a calibration: doubles and outliers out, all others in one optimisation, judged. */
#include "calibrate/calibrate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SAME_PX 1.0       /* boards whose corners moved less than this are one view */
#define OUTLIER_RATIO 3.0 /* of a view's error to the median view's */
#define GROSS_RATIO 10.0  /* the same before anything is solved together */
#define OUTLIER_SHARE 3   /* at most one in so many views is left out */

/* Mean distance of the corners of two sights, pixels; INFINITY when they are not the same ones. */
static double sight_distance(const calibrate_sight *a, const calibrate_sight *b)
{
    double sum = 0.0;
    if (a->count != b->count || a->count == 0) {
        return INFINITY;
    }
    for (int32_t i = 0; i < a->count; i++) {
        const calibrate_point *p = &a->points[i], *q = &b->points[i];
        if (p->x != q->x || p->y != q->y) {
            return INFINITY;
        }
        sum += sqrt((p->u - q->u) * (p->u - q->u) + (p->v - q->v) * (p->v - q->v));
    }
    return sum / a->count;
}

static void leave_doubles(calibrate_views *v)
{
    for (int32_t i = 1; i < v->count; i++) {
        for (int32_t k = 0; k < i && v->views[i].is_used; k++) {
            for (int c = 0; c < CALIBRATE_CAMERAS && v->views[k].is_used; c++) {
                if (v->views[i].is_used &&
                    sight_distance(&v->views[i].sight[c], &v->views[k].sight[c]) < SAME_PX) {
                    calibrate_view_leave(&v->views[i], "shows the board where %s has it",
                                         calibrate_view_name(&v->views[k]));
                }
            }
        }
    }
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Error of one view with its own pose solved anew. */
static double pose_rms(calibration *c, int32_t index)
{
    calibrate_views alone = c->views;
    calibrate_model model = c->model;
    calibrate_fit fit;
    alone.views = &c->views.views[index];
    alone.count = 1;
    memset(model.is_fixed, true, sizeof(model.is_fixed));
    return calibrate_solve(&alone, &model, &fit) == RLF_OK ? fit.rms : INFINITY;
}

/* The used view with the largest error, its pose solved anew by the lenses as they are, or as it
 * is; out_ratio is that to the median. */
static int32_t worst_view(calibration *c, bool by_pose, double *out_ratio)
{
    double errors[CALIBRATE_VIEWS_MAX], sorted[CALIBRATE_VIEWS_MAX];
    int32_t worst = -1, count = 0;
    for (int32_t i = 0; i < c->views.count; i++) {
        if (!c->views.views[i].is_used) {
            continue;
        }
        errors[i] = by_pose ? pose_rms(c, i) : calibrate_view_rms(&c->views.views[i], &c->model);
        sorted[count++] = errors[i];
        worst = worst < 0 || errors[i] > errors[worst] ? i : worst;
    }
    qsort(sorted, (size_t)count, sizeof(sorted[0]), by_value);
    *out_ratio = worst >= 0 ? errors[worst] / rlf_max(sorted[count / 2], 1e-6) : 0.0;
    return worst;
}

/* The sight in a mirrored picture. There OpenCV numbers the corners from the other side, left to
 * right or top to bottom. */
static void mirror(calibrate_sight *sight, int32_t width, bool is_by_rows)
{
    for (int32_t i = 0; i < sight->count; i++) {
        calibrate_point *p = &sight->points[i];
        p->u = width - 1 - p->u;
        p->x = is_by_rows ? p->x : -p->x;
        p->y = is_by_rows ? -p->y : p->y;
    }
}

/* The camera whose picture of this view fits when it is mirrored, or -1. */
static int mirrored_camera(calibration *c, int32_t index)
{
    calibrate_view *view = &c->views.views[index];
    const rlf_pose kept = view->T_first_board;
    const double as_is = pose_rms(c, index);
    int found = -1;
    for (int way = 0; way < 2 * CALIBRATE_CAMERAS; way++) {
        calibrate_sight *sight = &view->sight[way / 2];
        mirror(sight, c->views.width[way / 2], way % 2 == 1);
        view->T_first_board = kept;
        found = sight->count > 0 && pose_rms(c, index) < 0.2 * as_is ? way / 2 : found;
        mirror(sight, c->views.width[way / 2], way % 2 == 1);
    }
    view->T_first_board = kept;
    return found;
}

static void leave_outlier(calibration *c, int32_t index, double ratio)
{
    calibrate_view *view = &c->views.views[index];
    const double rms = calibrate_view_rms(view, &c->model);
    const int camera = mirrored_camera(c, index);
    if (camera >= 0) {
        calibrate_view_leave(view,
                             "does not fit the others (%.1f px), but would if the %s picture "
                             "were mirrored",
                             rms, c->views.camera_name[camera]);
    } else {
        calibrate_view_leave(view, "does not fit the others: %.2f px, %.1f times the median", rms,
                             ratio);
    }
}

/* Seeds, and leaves out what is far off already: the motion that most views agree on does not know
 * of it, whereas least squares would spread its error over all views. */
static rlf_result seed(const calibrate_options *o, const relief_opencv_api *api, calibration *c,
                       int32_t *most)
{
    rlf_result result = calibrate_seed(api, &c->views, &c->model);
    for (; result == RLF_OK && *most > 0 && !o->keeps_outliers; --*most) {
        double ratio;
        const int32_t worst = worst_view(c, true, &ratio);
        if (ratio < GROSS_RATIO) {
            break;
        }
        leave_outlier(c, worst, ratio);
        result = calibrate_seed(api, &c->views, &c->model);
    }
    return result;
}

static rlf_result fit_without_outliers(const calibrate_options *o, const relief_opencv_api *api,
                                       calibration *c)
{
    int32_t most = calibrate_views_used(&c->views, -1) / OUTLIER_SHARE;
    rlf_result result = seed(o, api, c, &most);
    for (; result == RLF_OK; --most) {
        double ratio;
        result = calibrate_solve(&c->views, &c->model, &c->fit);
        const int32_t worst = worst_view(c, false, &ratio);
        if (ratio < OUTLIER_RATIO || most == 0 || o->keeps_outliers) {
            break;
        }
        leave_outlier(c, worst, ratio);
    }
    return result;
}

/* After a fit that is off everywhere: whether it is good once all pictures of the second camera are
 * mirrored. */
static bool is_all_mirrored(const relief_opencv_api *api, calibration *c)
{
    const double as_is = c->fit.rms;
    bool is_mirrored = false;
    for (int way = 0; way < 2 && c->views.camera_count == 2 && !is_mirrored; way++) {
        for (int32_t i = 0; i < c->views.count; i++) {
            mirror(&c->views.views[i].sight[1], c->views.width[1], way == 1);
        }
        is_mirrored = calibrate_seed(api, &c->views, &c->model) == RLF_OK &&
                      calibrate_solve(&c->views, &c->model, &c->fit) == RLF_OK &&
                      c->fit.rms < 0.2 * as_is;
        for (int32_t i = 0; i < c->views.count; i++) {
            mirror(&c->views.views[i].sight[1], c->views.width[1], way == 1);
        }
    }
    return is_mirrored;
}

/* The reason of a refusal, better where it is known better. */
static rlf_result explain(const relief_opencv_api *api, calibration *c, rlf_result result)
{
    if (result == RLF_OK || c->fit.rms < 2.0) {
        return result;
    }
    char reason[512];
    snprintf(reason, sizeof(reason), "%s", rlf_error_text());
    return is_all_mirrored(api, c)
               ? rlf_fail(RLF_ERROR_INVALID,
                          "the pictures of one camera are mirrored: those of both fit once the %s "
                          "ones are mirrored",
                          c->views.camera_name[1])
               : rlf_fail(result, "%s", reason);
}

static rlf_result measure(calibration *c)
{
    rlf_result result = RLF_OK;
    for (int32_t k = 0; k < CALIBRATE_CAMERAS && result == RLF_OK; k++) {
        c->leave_one_out[k] = NAN;
        if (calibrate_views_used(&c->views, k) > 0 && !c->model.is_fixed[CALIBRATE_LENS * k]) {
            result = calibrate_leave_one_out(&c->views, &c->model, k, &c->leave_one_out[k]);
        }
    }
    const bool has_both = c->views.camera_count == CALIBRATE_CAMERAS;
    c->epipolar = has_both ? calibrate_epipolar(&c->views, &c->model) : NAN;
    c->mapping_p95 =
        has_both ? calibrate_map_deviation(&c->model, &c->fit, calibrate_distance(&c->views)) : NAN;
    return result;
}

void calibration_free(calibration *c)
{
    calibrate_views_destroy(&c->views);
    rlf_free(c->sample.data);
    rlf_free(c->sample_depth);
}

rlf_result calibrate_finish(const calibrate_options *options, calibration *c)
{
    const relief_opencv_api *api = opencv_get();
    if (api == NULL) {
        return RLF_ERROR_UNSUPPORTED;
    }
    leave_doubles(&c->views);
    rlf_result result = calibrate_judge_views(&c->views, &c->model);
    if (result == RLF_OK) {
        result = fit_without_outliers(options, api, c);
    }
    if (result == RLF_OK) {
        result = calibrate_judge_views(&c->views, &c->model);
    }
    if (result == RLF_OK) {
        result = explain(api, c, calibrate_judge_fit(&c->views, &c->model, &c->fit));
    }
    return result == RLF_OK ? measure(c) : result;
}
