/* On each board: what depth says minus where the plane through the corners is (as iai_kinect2 has
 * it). The pixel's own ray is used, so a slanted board is as good as a frontal one. */
#include "calibrate/calibrate.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Depth of the board's plane along the pixel's ray, where the ray meets the lattice; else 0. */
static double plane_depth(const rlf_pose *T_camera_board, const double half[2], rlf_vec3 ray)
{
    const rlf_vec3 normal = rlf_rotate(T_camera_board->q, rlf_vec3_make(0, 0, 1));
    const double across = rlf_dot(normal, ray);
    const double z = across != 0.0 ? rlf_dot(normal, T_camera_board->p) / across : 0.0;
    const rlf_vec3 at = rlf_transform_inverse(T_camera_board, rlf_scale(ray, z));
    return z > 0.0 && fabs(at.x) <= half[0] && fabs(at.y) <= half[1] ? z : 0.0;
}

/* Pixels that the lattice can cover: left, top, right, bottom, inclusive; false when it is not all
 * in the picture. */
static bool find_box(const rlf_pose *T, const double half[2], const rlf_camera *camera,
                     int32_t box[4])
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) {
        const rlf_vec3 corner = {i % 2 == 0 ? -half[0] : half[0], i < 2 ? -half[1] : half[1], 0.0};
        double at[2];
        if (!rlf_camera_project(camera, rlf_transform(T, corner), &at[0], &at[1])) {
            return false;
        }
        for (int k = 0; k < 2; k++) {
            low[k] = rlf_min(low[k], at[k]);
            high[k] = rlf_max(high[k], at[k]);
        }
    }
    if (low[0] < 0.0 || low[1] < 0.0 || high[0] > camera->width - 1 ||
        high[1] > camera->height - 1) {
        return false;
    }
    for (int k = 0; k < 2; k++) {
        box[k] = (int32_t)low[k];
        box[2 + k] = (int32_t)high[k];
    }
    return true;
}

double depth_offset_on(const calibrate_view *view, const calibrate_board *board,
                       const rlf_camera *camera, const float *depth)
{
    const double half[2] = {0.5 * (board->columns - 1) * board->square_m,
                            0.5 * (board->rows - 1) * board->square_m};
    int32_t box[4];
    if (!find_box(&view->T_first_board, half, camera, box)) {
        return NAN;
    }
    const int32_t width = box[2] - box[0] + 1, height = box[3] - box[1] + 1;
    double *values = rlf_alloc_array((size_t)width * (size_t)height, sizeof(*values));
    size_t count = 0, inside = 0;
    for (int32_t i = 0; values != NULL && i < width * height; i++) {
        rlf_vec3 ray;
        const int32_t u = box[0] + i % width, v = box[1] + i / width;
        const bool has_ray = rlf_camera_unproject(camera, u, v, &ray);
        const double z = has_ray ? plane_depth(&view->T_first_board, half, ray) : 0.0;
        const double measured = depth[(int64_t)v * camera->width + u];
        inside += z > 0.0;
        if (z > 0.0 && measured > 0.0) {
            values[count++] = measured - z;
        }
    }
    double median = NAN;
    if (count > 0 && 2 * count >= inside) {
        qsort(values, count, sizeof(*values), by_value);
        median = values[count / 2];
    }
    rlf_free(values);
    return median;
}

/* What the boards' scatter does not show, as it is the same for all: their distance is as sure as
 * the focal length, and, where colour found them, as the motion from colour to depth. */
static double pose_variance(const calibration *c)
{
    const int camera = c->is_thesis_way || c->model.is_fixed[0] ? 1 : 0;
    const double share = calibrate_deviation(&c->fit, CALIBRATE_LENS * camera) /
                         rlf_max(c->model.camera[camera].fx, 1.0);
    const double by_focal = calibrate_distance(&c->views) * share;
    const double by_motion = camera == 1 ? calibrate_deviation(&c->fit, CALIBRATE_MOTION + 5) : 0.0;
    return by_focal * by_focal + by_motion * by_motion;
}

void depth_offset_combine(calibration *c)
{
    double sum = 0.0, squares = 0.0;
    int32_t n = 0;
    for (int32_t i = 0; i < c->views.count; i++) {
        const calibrate_view *view = &c->views.views[i];
        if (view->is_used && !isnan(view->offset_m)) {
            sum += view->offset_m;
            squares += view->offset_m * view->offset_m;
            n++;
        }
    }
    c->offset_boards = n;
    c->offset_m = n > 0 ? sum / n : NAN;
    c->offset_deviation_m =
        n > 1 ? sqrt(rlf_max(squares - sum * sum / n, 0.0) / (n - 1) / n + pose_variance(c)) : NAN;
}
