/* Monte Carlo of a Kinect v2: 20 views of a 9x6 board of 30 mm squares, 0.6 to 1.5 m away, tilted
 * by up to 40 degrees, corners found to 0.1 px. */
#include "eval/calibration/calibration.h"

#include "calibrate/quality.h"
#include "calibrate/seed.h"
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

/* Sums over the trials of one way. */
typedef struct errors {
    double focal, motion; /* squares: relative, metres */
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
    rlf_result result =
        calibrate_sight_resize(&view->sight[0], is_outline ? 4 : corners);
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
    for (int c = 0; c < CALIBRATE_CAMERAS; c++) {
        const double share = found->camera[c].fx / truth->camera[c].fx - 1.0;
        e->focal = c == 0 ? e->focal + share * share : e->focal;
    }
    const rlf_vec3 d = rlf_sub(found->T_second_first.p, truth->T_second_first.p);
    e->motion += rlf_dot(d, d);
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

/* The thesis's way begins at the truth, with the lenses known to be free of distortion: what is
 * left is what four corners cannot tell. */
static rlf_result solve(const relief_opencv_api *api, bool is_outline, const calibrate_model *truth,
                        calibrate_views *views, calibrate_model *found)
{
    calibrate_fit fit;
    *found = *truth;
    for (int i = 4; i < CALIBRATE_LENS && is_outline; i++) {
        found->is_fixed[i] = true;
    }
    rlf_result result = is_outline ? RLF_OK : calibrate_seed(api, views, found);
    return result == RLF_OK ? calibrate_solve(views, found, &fit) : result;
}

static rlf_result run_trial(const relief_opencv_api *api, bool is_outline, eval_random *r,
                            errors *e)
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
        result = add_view(&truth, is_outline, r, &views);
    }
    if (result == RLF_OK) {
        result = solve(api, is_outline, &truth, &views, &found);
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

static void report(eval_table *table, errors *e, rlf_profile profile)
{
    double sum = 0.0;
    for (int32_t i = 0; i < e->map_count; i++) {
        sum += e->map[i];
    }
    qsort(e->map, (size_t)e->map_count, sizeof(e->map[0]), by_value);
    eval_table_add(table, SCENE, "map_mean_px", "20 views: depth in colour, mean error, px",
                   profile, sum / e->map_count);
    eval_table_add(table, SCENE, "map_p95_px", "20 views: depth in colour, error p95, px", profile,
                   e->map[(int32_t)(0.95 * (e->map_count - 1))]);
    eval_table_add(table, SCENE, "baseline_mm", "20 views: error of the baseline, mm", profile,
                   1e3 * sqrt(e->motion / e->trials));
    eval_table_add(table, SCENE, "focal_percent", "20 views: error of the focal length, %", profile,
                   100.0 * sqrt(e->focal / e->trials));
}

rlf_result eval_calibration_run(eval_table *table, int64_t seed, int profile_mask)
{
    const relief_opencv_api *api = opencv_get();
    if (api == NULL) {
        rlf_log(RLF_LOG_WARNING, "calibration is not measured: %s", rlf_error_text());
        return RLF_OK;
    }
    errors *e = rlf_alloc(sizeof(*e));
    rlf_result result = e != NULL ? RLF_OK : RLF_ERROR_MEMORY;
    for (int profile = 0; profile < EVAL_PROFILES && result == RLF_OK; profile++) {
        if (!(profile_mask & (1 << profile))) {
            continue;
        }
        memset(e, 0, sizeof(*e));
        eval_random random = eval_random_start((uint64_t)seed);
        for (int i = 0; i < TRIALS && result == RLF_OK; i++) {
            result = run_trial(api, profile == RLF_PROFILE_THESIS, &random, e);
        }
        if (result == RLF_OK) {
            report(table, e, (rlf_profile)profile);
        }
    }
    rlf_free(e);
    return result;
}
