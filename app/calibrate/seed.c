/* Calls of OpenCV's calibration, and the one motion that the views agree on. */
#include "calibrate/solve.h"

#include <math.h>
#include <string.h>

/* The views of one camera as OpenCV takes them; `view` has their places in calibrate_views. */
typedef struct packed {
    relief_opencv_views views;
    int32_t counts[CALIBRATE_VIEWS_MAX], view[CALIBRATE_VIEWS_MAX];
    float *board, *pixel;
} packed;

static void packed_free(packed *p)
{
    rlf_free(p->board);
    rlf_free(p->pixel);
}

static bool is_wanted(const calibrate_view *view, int32_t camera, bool needs_both)
{
    return view->is_used && view->sight[camera].count > 0 &&
           (!needs_both || view->sight[1 - camera].count > 0);
}

static void pack_view(const calibrate_sight *sight, int32_t at, packed *p)
{
    for (int32_t k = 0; k < sight->count; k++) {
        const calibrate_point *point = &sight->points[k];
        float *board = &p->board[3 * (at + k)], *pixel = &p->pixel[2 * (at + k)];
        board[0] = (float)point->x;
        board[1] = (float)point->y;
        board[2] = 0.0F;
        pixel[0] = (float)point->u;
        pixel[1] = (float)point->v;
    }
}

static rlf_result pack(const calibrate_views *v, int32_t camera, bool needs_both, packed *p)
{
    int32_t points = 0;
    *p = (packed){.views = {.width = v->width[camera], .height = v->height[camera]}};
    for (int32_t i = 0; i < v->count; i++) {
        points += is_wanted(&v->views[i], camera, needs_both) ? v->views[i].sight[camera].count : 0;
    }
    p->board = rlf_alloc_array((size_t)points + 1, 3 * sizeof(float));
    p->pixel = rlf_alloc_array((size_t)points + 1, 2 * sizeof(float));
    if (p->board == NULL || p->pixel == NULL) {
        packed_free(p);
        return RLF_ERROR_MEMORY;
    }
    points = 0;
    for (int32_t i = 0; i < v->count; i++) {
        if (is_wanted(&v->views[i], camera, needs_both)) {
            const calibrate_sight *sight = &v->views[i].sight[camera];
            pack_view(sight, points, p);
            p->view[p->views.count] = i;
            p->counts[p->views.count++] = sight->count;
            points += sight->count;
        }
    }
    p->views.counts = p->counts;
    p->views.board = p->board;
    p->views.pixel = p->pixel;
    return RLF_OK;
}

static rlf_pose pose_of(const double motion[6])
{
    return (rlf_pose){
        .q = rlf_quat_from_rotation_vector(rlf_vec3_make(motion[0], motion[1], motion[2])),
        .p = rlf_vec3_make(motion[3], motion[4], motion[5])};
}

static rlf_camera camera_of(const relief_opencv_lens *lens, int32_t width, int32_t height)
{
    rlf_camera camera = {.width = width,
                         .height = height,
                         .fx = lens->f[0],
                         .fy = lens->f[1],
                         .cx = lens->c[0],
                         .cy = lens->c[1],
                         .distortion_model = RLF_DISTORTION_PLUMB_BOB};
    memcpy(camera.distortion, lens->k, sizeof(lens->k));
    return camera;
}

static relief_opencv_lens lens_of(const rlf_camera *camera)
{
    relief_opencv_lens lens = {.f = {camera->fx, camera->fy}, .c = {camera->cx, camera->cy}};
    memcpy(lens.k, camera->distortion, sizeof(lens.k));
    return lens;
}

static rlf_result gave_up(const relief_opencv_api *api)
{
    return rlf_fail(RLF_ERROR_INVALID, "OpenCV could not calibrate from these pictures: %.200s",
                    api->error());
}

/* One camera by itself: its lens, and the board's pose in its frame in each of its views. */
static rlf_result calibrate_one(const relief_opencv_api *api, const calibrate_views *views,
                                int32_t camera, rlf_camera *lens, rlf_pose *poses)
{
    double found[CALIBRATE_VIEWS_MAX][6];
    packed p;
    relief_opencv_lens out;
    double rms;
    rlf_result result = pack(views, camera, false, &p);
    if (result != RLF_OK) {
        return result;
    }
    if (api->calibrate(&p.views, &out, found, &rms) == 1) {
        *lens = camera_of(&out, views->width[camera], views->height[camera]);
        for (int32_t i = 0; i < p.views.count; i++) {
            poses[p.view[i]] = pose_of(found[i]);
        }
    } else {
        result = gave_up(api);
    }
    packed_free(&p);
    return result;
}

/* How far two motions take a point a metre away apart, metres. */
static double apart(const rlf_pose *a, const rlf_pose *b)
{
    const rlf_vec3 ahead = rlf_vec3_make(0, 0, 1);
    return rlf_length(rlf_sub(rlf_transform(a, ahead), rlf_transform(b, ahead))) +
           rlf_length(rlf_sub(a->p, b->p));
}

/* The medoid of the motions that the views give each by itself: outliers do not move it. */
static bool choose_motion(const calibrate_views *views, rlf_pose *const poses[CALIBRATE_CAMERAS],
                          rlf_pose *out)
{
    double best = INFINITY;
    for (int32_t i = 0; i < views->count; i++) {
        if (!is_wanted(&views->views[i], 0, true)) {
            continue;
        }
        const rlf_pose inverse = rlf_pose_invert(&poses[0][i]);
        const rlf_pose T = rlf_pose_mul(&poses[1][i], &inverse);
        double sum = 0.0;
        for (int32_t k = 0; k < views->count; k++) {
            if (is_wanted(&views->views[k], 0, true)) {
                const rlf_pose other = rlf_pose_invert(&poses[0][k]);
                const rlf_pose there = rlf_pose_mul(&poses[1][k], &other);
                sum += apart(&T, &there);
            }
        }
        if (sum < best) {
            best = sum;
            *out = T;
        }
    }
    return isfinite(best);
}

static void turn_half(calibrate_sight *sight)
{
    for (int32_t i = 0; i < sight->count; i++) {
        sight->points[i].x = -sight->points[i].x;
        sight->points[i].y = -sight->points[i].y;
    }
}

/* A board whose pattern is its own half turn may be numbered from either end: the second camera
 * follows the first. */
static void agree(calibrate_view *view, const calibrate_model *model)
{
    const double as_is = calibrate_errors(view, model, 1, NULL);
    turn_half(&view->sight[1]);
    if (!(calibrate_errors(view, model, 1, NULL) < 0.25 * as_is)) {
        turn_half(&view->sight[1]);
    }
}

/* OpenCV seeds all of a lens or nothing of it. */
static bool is_lens_fixed(const calibrate_model *model, int32_t camera)
{
    return model->is_fixed[camera * CALIBRATE_LENS + 4];
}

static rlf_result seed_poses(calibrate_views *views, calibrate_model *model,
                             rlf_pose *const poses[CALIBRATE_CAMERAS])
{
    const bool has_first = !is_lens_fixed(model, 0);
    const bool has_motion = !has_first || views->camera_count < 2 ||
                            choose_motion(views, poses, &model->T_second_first);
    if (!has_motion) {
        return rlf_fail(RLF_ERROR_INVALID, "no board is seen by both cameras at once: pictures of "
                                           "the same moment need the same number in their names");
    }
    const rlf_pose back = rlf_pose_invert(&model->T_second_first);
    for (int32_t i = 0; i < views->count; i++) {
        calibrate_view *view = &views->views[i];
        const bool is_by_first = has_first && view->sight[0].count > 0;
        view->T_first_board = is_by_first ? poses[0][i] : rlf_pose_mul(&back, &poses[1][i]);
        if (is_by_first && is_wanted(view, 1, true)) {
            agree(view, model);
        }
    }
    return RLF_OK;
}

rlf_result calibrate_seed(const relief_opencv_api *api, calibrate_views *views,
                          calibrate_model *model)
{
    rlf_pose *all =
        rlf_alloc_array((size_t)CALIBRATE_CAMERAS * CALIBRATE_VIEWS_MAX, sizeof(rlf_pose));
    if (all == NULL) {
        return RLF_ERROR_MEMORY;
    }
    rlf_pose *const poses[CALIBRATE_CAMERAS] = {all, all + CALIBRATE_VIEWS_MAX};
    rlf_result result = RLF_OK;
    for (int32_t c = 0; c < CALIBRATE_CAMERAS && result == RLF_OK; c++) {
        if (!is_lens_fixed(model, c) && calibrate_views_used(views, c) > 0) {
            result = calibrate_one(api, views, c, &model->camera[c], poses[c]);
        }
    }
    result = result == RLF_OK ? seed_poses(views, model, poses) : result;
    rlf_free(all);
    return result;
}

rlf_result calibrate_opencv_stereo(const relief_opencv_api *api, const calibrate_views *views,
                                   calibrate_model *model, double *out_rms)
{
    packed p[CALIBRATE_CAMERAS];
    rlf_result result = pack(views, 0, true, &p[0]);
    if (result != RLF_OK) {
        return result;
    }
    result = pack(views, 1, true, &p[1]);
    if (result == RLF_OK) {
        relief_opencv_lens lenses[] = {lens_of(&model->camera[0]), lens_of(&model->camera[1])};
        double motion[6];
        if (api->stereo(&p[0].views, &p[1].views, lenses, motion, out_rms) == 1) {
            for (int c = 0; c < CALIBRATE_CAMERAS; c++) {
                model->camera[c] = camera_of(&lenses[c], views->width[c], views->height[c]);
            }
            model->T_second_first = pose_of(motion);
        } else {
            result = gave_up(api);
        }
        packed_free(&p[1]);
    }
    packed_free(&p[0]);
    return result;
}
