/* plumb_bob is linear in its coefficients: a lens known by samples is fitted without iteration. */
#include "io/live/driver.h"
#include <math.h>
#include <string.h>

/* ---- linear least squares by normal equations and Cholesky's factorisation --------------- */

void io_least_squares_add(io_least_squares *ls, const double *row, double value)
{
    for (int32_t i = 0; i < ls->count; i++) {
        for (int32_t k = 0; k <= i; k++) {
            ls->a[i][k] += row[i] * row[k];
        }
        ls->b[i] += row[i] * value;
    }
}

/* The lower triangle of a becomes L with L L^T = a. */
static bool factorise(io_least_squares *ls)
{
    for (int32_t i = 0; i < ls->count; i++) {
        for (int32_t k = 0; k <= i; k++) {
            double sum = ls->a[i][k];
            for (int32_t j = 0; j < k; j++) {
                sum -= ls->a[i][j] * ls->a[k][j];
            }
            if (k < i) {
                ls->a[i][k] = sum / ls->a[k][k];
            } else if (sum > 1e-14 * ls->a[i][i]) { /* a multiple of double's rounding */
                ls->a[i][i] = sqrt(sum);
            } else {
                return false;
            }
        }
    }
    return true;
}

bool io_least_squares_solve(io_least_squares *ls, double *out)
{
    if (!factorise(ls)) {
        return false;
    }
    for (int32_t i = 0; i < ls->count; i++) {
        double sum = ls->b[i];
        for (int32_t j = 0; j < i; j++) {
            sum -= ls->a[i][j] * out[j];
        }
        out[i] = sum / ls->a[i][i];
    }
    for (int32_t i = ls->count - 1; i >= 0; i--) {
        double sum = out[i];
        for (int32_t j = i + 1; j < ls->count; j++) {
            sum -= ls->a[j][i] * out[j];
        }
        out[i] = sum / ls->a[i][i];
    }
    return true;
}

static void add_sample(io_least_squares *ls, const io_lens_sample *s, const rlf_camera *camera)
{
    const double r2 = s->x * s->x + s->y * s->y;
    const double radial[3] = {r2, r2 * r2, r2 * r2 * r2};
    const double xy = 2.0 * s->x * s->y;
    /* k1 k2 p1 p2 k3; in pixels, so that both axes weigh alike. */
    const double row_u[5] = {camera->fx * s->x * radial[0], camera->fx * s->x * radial[1],
                             camera->fx * xy, camera->fx * (r2 + 2.0 * s->x * s->x),
                             camera->fx * s->x * radial[2]};
    const double row_v[5] = {camera->fy * s->y * radial[0], camera->fy * s->y * radial[1],
                             camera->fy * (r2 + 2.0 * s->y * s->y), camera->fy * xy,
                             camera->fy * s->y * radial[2]};
    io_least_squares_add(ls, row_u, s->u - camera->fx * s->x - camera->cx);
    io_least_squares_add(ls, row_v, s->v - camera->fy * s->y - camera->cy);
}

/* Infinity when a ray is not seen at all. */
static double worst_distance(const io_lens_sample *samples, int32_t count, const rlf_camera *camera)
{
    double worst_px = 0.0;
    for (int32_t i = 0; i < count; i++) {
        const io_lens_sample *s = &samples[i];
        double u = NAN;
        double v = NAN;
        rlf_camera_project(camera, rlf_vec3_make(s->x, s->y, 1.0), &u, &v);
        const double off_px = hypot(u - s->u, v - s->v);
        worst_px = off_px <= worst_px ? worst_px : off_px;
        if (!isfinite(worst_px)) {
            return INFINITY;
        }
    }
    return worst_px;
}

double io_lens_fit(const io_lens_sample *samples, int32_t count, rlf_camera *camera)
{
    io_least_squares ls = {.count = 5};
    for (int32_t i = 0; i < count; i++) {
        add_sample(&ls, &samples[i], camera);
    }
    const rlf_camera pinhole = {.width = camera->width,
                                .height = camera->height,
                                .fx = camera->fx,
                                .fy = camera->fy,
                                .cx = camera->cx,
                                .cy = camera->cy};
    *camera = pinhole;
    double k[5];
    if (!io_least_squares_solve(&ls, k)) {
        return INFINITY;
    }
    camera->distortion_model = RLF_DISTORTION_PLUMB_BOB;
    memcpy(camera->distortion, k, sizeof(k));
    const double worst_px = worst_distance(samples, count, camera);
    *camera = isfinite(worst_px) ? *camera : pinhole;
    return worst_px;
}
