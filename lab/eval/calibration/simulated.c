/* Monte Carlo of a Kinect v2: 20 views of a 9x6 board of 30 mm squares, 0.6 to 1.5 m away, tilted
 * by up to 40 degrees, corners found to 0.1 px, the outline's corners in depth to 1 px. */
#include "eval/calibration/calibration.h"

#include "calibrate/solve.h"
#include "eval/analytic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SCENE "calibration"
#define VIEWS 20
#define TRIALS 10 /* of each seed */
#define NOISE_PX 0.1
#define OUTLINE_NOISE_PX 1.0 /* of a corner where depth ends */
#define TILT_MAX 0.698       /* radians */
#define SCENE_DISTANCE_M 1.0

static const calibrate_board board = {
    .columns = 9, .rows = 6, .square_m = 0.03, .outline_m = {0.3, 0.21}};

/* How the depth camera sees the board. */
typedef enum way {
    WAY_CORNERS = 0, /* inner corners in infrared pictures */
    WAY_OUTLINE = 1, /* the outline's corners in depth, in one optimisation with colour */
    WAY_THESIS = 2   /* the same corners, each camera by itself */
} way;

/* Sums over the trials of one way. */
typedef struct errors {
    double focal, baseline, motion; /* squares: relative, metres, metres */
    double map[TRIALS * CALIBRATE_MAP_POINTS];
    int32_t map_count, trials;
} errors;

static calibrate_model true_model(void)
{
    calibrate_model m = {.T_second_first = rlf_pose_identity()};
    m.camera[0] = (rlf_camera){.width = 512,
                               .height = 424,
                               .fx = 365.5,
                               .fy = 365.5,
                               .cx = 257.0,
                               .cy = 206.5,
                               .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                               .distortion = {0.09, -0.27, 0.0, 0.0, 0.09}};
    m.camera[1] = (rlf_camera){.width = 1920,
                               .height = 1080,
                               .fx = 1060.0,
                               .fy = 1060.0,
                               .cx = 959.5,
                               .cy = 539.5,
                               .distortion_model = RLF_DISTORTION_PLUMB_BOB,
                               .distortion = {0.03, -0.05, 0.0, 0.0, 0.0}};
    m.T_second_first.p = rlf_vec3_make(-0.052, 0.0, 0.0);
    m.T_second_first.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.004, -0.006, 0.003));
    return m;
}

static rlf_pose draw_pose(eval_random *r, const rlf_camera *camera)
{
    const double z = eval_random_range(r, 0.6, 1.5);
    const double turn = eval_random_range(r, -3.14159, 3.14159);
    const double tilt = eval_random_range(r, 0.0, TILT_MAX);
    const double roll = eval_random_range(r, -0.3, 0.3);
    const double u = eval_random_range(r, 0.0, camera->width);
    const double v = eval_random_range(r, 0.0, camera->height);
    const rlf_quat q = rlf_quat_mul(
        rlf_quat_from_rotation_vector(rlf_vec3_make(tilt * rlf_cos(turn), tilt * rlf_sin(turn), 0)),
        rlf_quat_from_rotation_vector(rlf_vec3_make(0, 0, roll)));
    return (rlf_pose){.q = q,
                      .p = rlf_vec3_make((u - camera->cx) / camera->fx * z,
                                         (v - camera->cy) / camera->fy * z, z)};
}

/* Projects the sight's board points; false when one is outside the picture. */
static bool see(const calibrate_model *model, const rlf_pose *T, int camera, double noise,
                eval_random *r, calibrate_sight *sight)
{
    const rlf_camera *lens = &model->camera[camera];
    for (int32_t i = 0; i < sight->count; i++) {
        calibrate_point *p = &sight->points[i];
        rlf_vec3 at = rlf_transform(T, rlf_vec3_make(p->x, p->y, 0.0));
        at = camera == 1 ? rlf_transform(&model->T_second_first, at) : at;
        if (!rlf_camera_project(lens, at, &p->u, &p->v) || p->u < 0.0 || p->v < 0.0 ||
            p->u > lens->width - 1 || p->v > lens->height - 1) {
            return false;
        }
        p->u += noise * eval_random_normal(r);
        p->v += noise * eval_random_normal(r);
    }
    return true;
}

static void place_points(calibrate_sight *sight, bool is_outline)
{
    for (int32_t i = 0; i < sight->count; i++) {
        calibrate_point *p = &sight->points[i];
        if (is_outline) {
            p->x = (i % 2 - 0.5) * board.outline_m[0];
            p->y = (i / 2 - 0.5) * board.outline_m[1];
        } else {
            calibrate_board_point(&board, i, &p->x, &p->y);
        }
    }
}

/* Draws poses until both cameras see the whole board. */
static rlf_result add_view(const calibrate_model *model, bool is_outline, eval_random *r,
                           calibrate_views *views)
{
    calibrate_view *view = calibrate_views_add(views);
    const int32_t corners = board.columns * board.rows;
    rlf_result result = calibrate_sight_resize(&view->sight[0], is_outline ? 4 : corners);
    if (result == RLF_OK) {
        result = calibrate_sight_resize(&view->sight[1], corners);
    }
    if (result != RLF_OK) {
        return result;
    }
    place_points(&view->sight[0], is_outline);
    place_points(&view->sight[1], false);
    view->sight[0].sigma = is_outline ? OUTLINE_NOISE_PX / NOISE_PX : 1.0;
    do {
        view->T_first_board = draw_pose(r, &model->camera[0]);
    } while (!see(model, &view->T_first_board, 0, is_outline ? OUTLINE_NOISE_PX : NOISE_PX, r,
                  &view->sight[0]) ||
             !see(model, &view->T_first_board, 1, NOISE_PX, r, &view->sight[1]));
    return RLF_OK;
}

static void add_errors(const calibrate_model *truth, const calibrate_model *found, errors *e)
{
    const double focal = found->camera[0].fx / truth->camera[0].fx - 1.0;
    const rlf_vec3 should_be = truth->T_second_first.p, is_at = found->T_second_first.p;
    const rlf_vec3 off = rlf_sub(is_at, should_be);
    const double longer = rlf_length(is_at) - rlf_length(should_be);
    e->focal += focal * focal;
    e->motion += rlf_dot(off, off);
    e->baseline += longer * longer;
    e->trials++;
    for (int32_t i = 0; i < CALIBRATE_MAP_POINTS; i++) {
        double u, v, z, is[2], should[2];
        calibrate_map_point(&truth->camera[0], SCENE_DISTANCE_M, i, &u, &v, &z);
        if (calibrate_map(truth, u, v, z, should) && should[0] >= 0.0 && should[1] >= 0.0 &&
            should[0] < truth->camera[1].width && should[1] < truth->camera[1].height &&
            calibrate_map(found, u, v, z, is)) {
            e->map[e->map_count++] = sqrt((is[0] - should[0]) * (is[0] - should[0]) +
                                          (is[1] - should[1]) * (is[1] - should[1]));
        }
    }
}

static void fix(calibrate_model *model, int32_t begin, int32_t end)
{
    for (int32_t i = begin; i < end; i++) {
        model->is_fixed[i] = true;
    }
}

static void hide_second(calibrate_views *views, int32_t count)
{
    for (int32_t i = 0; i < views->count; i++) {
        views->views[i].sight[1].count = count;
    }
}

/* The ways by the outline begin at the truth and know that lens's distortion: what is left is what
 * four corners cannot tell. */
static rlf_result solve(const relief_opencv_api *api, way w, const calibrate_model *truth,
                        calibrate_views *views, calibrate_model *found)
{
    calibrate_fit fit;
    *found = *truth;
    rlf_result result = RLF_OK;
    if (w == WAY_CORNERS) {
        result = calibrate_seed(api, views, found);
    } else {
        fix(found, 4, CALIBRATE_LENS);
    }
    if (w == WAY_THESIS) {
        hide_second(views, 0);
        result = calibrate_solve(views, found, &fit);
        hide_second(views, board.columns * board.rows);
        fix(found, 0, CALIBRATE_LENS);
    }
    return result == RLF_OK ? calibrate_solve(views, found, &fit) : result;
}

static rlf_result run_trial(const relief_opencv_api *api, way w, eval_random *r, errors *e)
{
    const calibrate_model truth = true_model();
    calibrate_model found;
    calibrate_views views;
    rlf_result result = calibrate_views_create(&board, &views);
    views.camera_count = CALIBRATE_CAMERAS;
    for (int c = 0; c < CALIBRATE_CAMERAS; c++) {
        views.width[c] = truth.camera[c].width;
        views.height[c] = truth.camera[c].height;
        views.camera_name[c] = c == 0 ? "depth" : "color";
    }
    for (int i = 0; i < VIEWS && result == RLF_OK; i++) {
        result = add_view(&truth, w != WAY_CORNERS, r, &views);
    }
    if (result == RLF_OK) {
        result = solve(api, w, &truth, &views, &found);
    }
    if (result == RLF_OK) {
        add_errors(&truth, &found, e);
    }
    calibrate_views_destroy(&views);
    return result;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct figure {
    const char *key, *title;
} figure;

static void report(eval_table *table, errors *e, const figure figures[5], rlf_profile profile)
{
    double sum = 0.0;
    for (int32_t i = 0; i < e->map_count; i++) {
        sum += e->map[i];
    }
    qsort(e->map, (size_t)e->map_count, sizeof(e->map[0]), by_value);
    const int32_t n = e->map_count;
    const double values[5] = {
        n > 0 ? sum / n : NAN, n > 0 ? e->map[(int32_t)(0.95 * (n - 1))] : NAN,
        1e3 * sqrt(e->baseline / e->trials), 1e3 * sqrt(e->motion / e->trials),
        100.0 * sqrt(e->focal / e->trials)};
    for (int i = 0; i < 5; i++) {
        eval_table_add(table, SCENE, figures[i].key, figures[i].title, profile, values[i]);
    }
}

static rlf_result run_way(eval_table *table, const relief_opencv_api *api, way w, int64_t seed)
{
    static const figure by_corners[5] = {
        {"map_mean_px", "20 views: depth in colour, mean error, px"},
        {"map_p95_px", "20 views: depth in colour, error p95, px"},
        {"baseline_mm", "20 views: error of the baseline, mm"},
        {"motion_mm", "20 views: error of the camera's place, mm"},
        {"focal_percent", "20 views: error of the focal length, %"}};
    static const figure by_outline[5] = {
        {"outline_map_mean_px", "by outline in depth: depth in colour, mean error, px"},
        {"outline_map_p95_px", "by outline in depth: depth in colour, error p95, px"},
        {"outline_baseline_mm", "by outline in depth: error of the baseline, mm"},
        {"outline_motion_mm", "by outline in depth: error of the place, mm"},
        {"outline_focal_percent", "by outline in depth: error of the focal length, %"}};
    errors *e = rlf_alloc(sizeof(*e));
    if (e == NULL) {
        return RLF_ERROR_MEMORY;
    }
    memset(e, 0, sizeof(*e));
    eval_random random = eval_random_start((uint64_t)seed);
    rlf_result result = RLF_OK;
    for (int i = 0; i < TRIALS && result == RLF_OK; i++) {
        result = run_trial(api, w, &random, e);
    }
    if (result == RLF_OK) {
        report(table, e, w == WAY_CORNERS ? by_corners : by_outline,
               w == WAY_THESIS ? RLF_PROFILE_THESIS : RLF_PROFILE_LIVE);
    }
    rlf_free(e);
    return result;
}

rlf_result eval_calibration_run(eval_table *table, int64_t seed, int profile_mask)
{
    if (profile_mask & (1 << RLF_PROFILE_LIVE)) {
        eval_calibration_lenses(table);
    }
    const relief_opencv_api *api = opencv_get();
    if (api == NULL) {
        rlf_log(RLF_LOG_WARNING, "calibration is not measured: %s", rlf_error_text());
        return RLF_OK;
    }
    rlf_result result = RLF_OK;
    for (int w = WAY_CORNERS; w <= WAY_THESIS && result == RLF_OK; w++) {
        const int profile = w == WAY_THESIS ? RLF_PROFILE_THESIS : RLF_PROFILE_LIVE;
        if (profile_mask & (1 << profile)) {
            result = run_way(table, api, (way)w, seed);
        }
    }
    return result;
}
