/* Leave-one-out error, epipolar error, and the uncertainty of the map from depth to colour. */
#include "calibrate/solve.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The views with one camera's sights alone; the points stay those of `views`. */
static rlf_result one_camera(const calibrate_views *views, int32_t camera, calibrate_views *out)
{
    *out = *views;
    out->views = rlf_alloc_array((size_t)views->count, sizeof(*out->views));
    if (out->views == NULL) {
        return RLF_ERROR_MEMORY;
    }
    memcpy(out->views, views->views, (size_t)views->count * sizeof(*out->views));
    for (int32_t i = 0; i < out->count; i++) {
        out->views[i].sight[1 - camera].count = 0;
        out->views[i].is_used = out->views[i].is_used && out->views[i].sight[camera].count > 0;
    }
    return RLF_OK;
}

static void fix(calibrate_model *model, int32_t begin, int32_t end)
{
    for (int32_t i = begin; i < end; i++) {
        model->is_fixed[i] = true;
    }
}

/* Sum of squares of view `index`, which the lens does not know. */
static rlf_result predict(calibrate_views *views, const calibrate_model *start, int32_t index,
                          int32_t camera, double *sum)
{
    calibrate_model model = *start;
    calibrate_fit fit;
    fix(&model, CALIBRATE_MOTION, CALIBRATE_SHARED);
    views->views[index].is_used = false;
    rlf_result result = calibrate_solve(views, &model, &fit);
    views->views[index].is_used = true;
    if (result != RLF_OK) {
        return result;
    }
    calibrate_views alone = *views;
    alone.views = &views->views[index];
    alone.count = 1;
    fix(&model, 0, CALIBRATE_SHARED);
    result = calibrate_solve(&alone, &model, &fit);
    *sum += calibrate_errors(&views->views[index], &model, camera, NULL);
    return result;
}

rlf_result calibrate_leave_one_out(const calibrate_views *views, const calibrate_model *model,
                                   int32_t camera, double *out_rms)
{
    *out_rms = NAN;
    if (calibrate_views_used(views, camera) < 3) {
        return RLF_OK;
    }
    calibrate_views copy;
    rlf_result result = one_camera(views, camera, &copy);
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t i = 0; i < views->count && result == RLF_OK; i++) {
        if (copy.views[i].is_used) {
            result = predict(&copy, model, i, camera, &sum);
            count += copy.views[i].sight[camera].count;
        }
    }
    rlf_free(copy.views);
    *out_rms = sqrt(sum / count);
    return result;
}

/* Distance of a pixel from the line l . (u, v, 1) = 0. */
static double line_distance(rlf_vec3 l, double u, double v)
{
    return fabs(l.x * u + l.y * v + l.z) / sqrt(l.x * l.x + l.y * l.y);
}

/* The line of a camera's undistorted picture in which the plane n . p = 0 through its centre
 * appears. */
static rlf_vec3 line_of(const rlf_camera *c, rlf_vec3 n)
{
    const double a = n.x / c->fx, b = n.y / c->fy;
    return rlf_vec3_make(a, b, n.z - a * c->cx - b * c->cy);
}

/* Both distances of one corner, or NAN where a lens has no ray for it. */
static double corner_epipolar(const calibrate_model *m, const calibrate_point *a,
                              const calibrate_point *b)
{
    const rlf_pose *T = &m->T_second_first;
    rlf_vec3 first, second;
    if (!rlf_camera_unproject(&m->camera[0], a->u, a->v, &first) ||
        !rlf_camera_unproject(&m->camera[1], b->u, b->v, &second)) {
        return NAN;
    }
    const rlf_vec3 n_second = rlf_cross(T->p, rlf_rotate(T->q, first));
    const rlf_vec3 back = rlf_rotate(rlf_quat_conjugate(T->q), second);
    const rlf_vec3 n_first = rlf_cross(rlf_rotate(rlf_quat_conjugate(T->q), T->p), back);
    const rlf_camera *c = m->camera;
    return line_distance(line_of(&c[1], n_second), c[1].fx * second.x + c[1].cx,
                         c[1].fy * second.y + c[1].cy) +
           line_distance(line_of(&c[0], n_first), c[0].fx * first.x + c[0].cx,
                         c[0].fy * first.y + c[0].cy);
}

double calibrate_epipolar(const calibrate_views *views, const calibrate_model *model)
{
    double sum = 0.0;
    int32_t count = 0;
    for (int32_t i = 0; i < views->count; i++) {
        const calibrate_sight *sight = views->views[i].sight;
        for (int32_t k = 0; views->views[i].is_used && k < sight[0].count; k++) {
            const calibrate_point *p = &sight[0].points[k];
            for (int32_t j = 0; j < sight[1].count; j++) {
                const calibrate_point *q = &sight[1].points[j];
                if (p->x == q->x && p->y == q->y) {
                    const double d = corner_epipolar(model, p, q);
                    sum += isnan(d) ? 0.0 : d;
                    count += isnan(d) ? 0 : 2;
                }
            }
        }
    }
    return count > 0 ? sum / count : NAN;
}

bool calibrate_map(const calibrate_model *model, double u, double v, double depth_m,
                   double out_pixel[2])
{
    rlf_vec3 ray;
    if (!rlf_camera_unproject(&model->camera[0], u, v, &ray)) {
        return false;
    }
    const rlf_vec3 p = rlf_transform(&model->T_second_first, rlf_scale(ray, depth_m));
    return rlf_camera_project(&model->camera[1], p, &out_pixel[0], &out_pixel[1]);
}

void calibrate_map_point(const rlf_camera *camera, double distance_m, int32_t index, double *out_u,
                         double *out_v, double *out_depth_m)
{
    static const double shares[3] = {0.6, 1.0, 2.0};
    const int32_t cell = index / 3;
    *out_u = (cell % 16 + 0.5) * camera->width / 16.0 - 0.5;
    *out_v = (cell / 16 % 12 + 0.5) * camera->height / 12.0 - 0.5;
    *out_depth_m = shares[index % 3] * distance_m;
}

/* Variance of the mapped pixel: trace of J C J^T, with J by differences of a tenth of a standard
 * deviation. False where nothing is seen by both. */
static bool map_variance(const calibrate_model *model, const calibrate_fit *fit, double distance_m,
                         int32_t index, double *out)
{
    double u, v, z, jacobian[CALIBRATE_SHARED][2] = {{0}};
    calibrate_map_point(&model->camera[0], distance_m, index, &u, &v, &z);
    for (int i = 0; i < CALIBRATE_SHARED; i++) {
        double step[CALIBRATE_SHARED] = {0}, plus[2], minus[2];
        const double h = 0.1 * calibrate_deviation(fit, i);
        if (!(h > 0.0)) {
            continue;
        }
        calibrate_model moved = *model;
        step[i] = h;
        calibrate_move(&moved, step);
        bool is_seen = calibrate_map(&moved, u, v, z, plus);
        moved = *model;
        step[i] = -h;
        calibrate_move(&moved, step);
        is_seen = is_seen && calibrate_map(&moved, u, v, z, minus);
        if (!is_seen) {
            return false;
        }
        jacobian[i][0] = (plus[0] - minus[0]) / (2.0 * h);
        jacobian[i][1] = (plus[1] - minus[1]) / (2.0 * h);
    }
    *out = 0.0;
    for (int i = 0; i < CALIBRATE_SHARED * CALIBRATE_SHARED; i++) {
        const int a = i / CALIBRATE_SHARED, b = i % CALIBRATE_SHARED;
        *out += fit->covariance[a][b] *
                (jacobian[a][0] * jacobian[b][0] + jacobian[a][1] * jacobian[b][1]);
    }
    return true;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double calibrate_distance(const calibrate_views *views)
{
    double values[CALIBRATE_VIEWS_MAX];
    int32_t count = 0;
    for (int32_t i = 0; i < views->count; i++) {
        if (views->views[i].is_used) {
            values[count++] = views->views[i].T_first_board.p.z;
        }
    }
    qsort(values, (size_t)count, sizeof(values[0]), by_value);
    return count > 0 ? values[count / 2] : 0.0;
}

double calibrate_map_deviation(const calibrate_model *model, const calibrate_fit *fit,
                               double distance_m)
{
    double values[CALIBRATE_MAP_POINTS];
    int32_t count = 0;
    for (int32_t i = 0; i < CALIBRATE_MAP_POINTS; i++) {
        double variance;
        if (map_variance(model, fit, distance_m, i, &variance)) {
            values[count++] = sqrt(rlf_max(variance, 0.0));
        }
    }
    qsort(values, (size_t)count, sizeof(values[0]), by_value);
    return count > 0 ? values[(int32_t)(0.95 * (count - 1))] : NAN;
}
