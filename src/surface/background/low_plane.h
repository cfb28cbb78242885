/* A plane by least squares through means of inverse depth. */
#ifndef RLF_SURFACE_BACKGROUND_LOW_PLANE_H
#define RLF_SURFACE_BACKGROUND_LOW_PLANE_H

#include "relief/math.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* Inverse depth is a + b x + c y along the ray (x, y, 1). */
typedef struct rlf_low_plane {
    double a, b, c;
    double noise; /* of a sample */
    double turn;  /* radians: error of its normal */
} rlf_low_plane;

typedef struct rlf_low_sums {
    double n, x, y, xx, xy, yy, w, xw, yw, ww, variance;
    int32_t count;
} rlf_low_sums;

/* A mean w of n samples of that variance. */
static inline void rlf_low_sums_add(rlf_low_sums *s, double n, double x, double y, double w,
                                    double variance)
{
    s->variance += n * variance;
    s->n += n;
    s->x += n * x;
    s->y += n * y;
    s->xx += n * x * x;
    s->xy += n * x * y;
    s->yy += n * y * y;
    s->w += n * w;
    s->xw += n * x * w;
    s->yw += n * y * w;
    s->ww += n * w * w;
    s->count++;
}

static inline double rlf_low_plane_at(const rlf_low_plane *p, double x, double y)
{
    return p->a + p->b * x + p->c * y;
}

/* Error of the normal about the middle of the means, from the covariance of the slopes. */
static inline double rlf_low_plane_turn(const rlf_low_plane *p, double variance,
                                        const double cov[3], double x, double y)
{
    const rlf_vec3 q = {p->b, p->c, p->a};
    rlf_vec3 u = {1.0, 0.0, -x}, v = {0.0, 1.0, -y};
    double square = rlf_dot(q, q);
    u = rlf_mad(u, q, -rlf_dot(u, q) / square);
    v = rlf_mad(v, q, -rlf_dot(v, q) / square);
    double sum = cov[0] * rlf_dot(u, u) + 2.0 * cov[1] * rlf_dot(u, v) + cov[2] * rlf_dot(v, v);
    return sqrt(rlf_max(0.0, variance * sum / square));
}

/* Of sums about the ray (x0, y0). Returns whether what is left of the means is at most `most_left`
 * of their samples' variance. */
static inline bool rlf_low_plane_solve(const rlf_low_sums *s, double x0, double y0,
                                       double most_left, rlf_low_plane *out)
{
    double mx = s->x / s->n, my = s->y / s->n, mw = s->w / s->n;
    double xx = s->xx - s->x * mx, xy = s->xy - s->x * my, yy = s->yy - s->y * my;
    double xw = s->xw - s->x * mw, yw = s->yw - s->y * mw, ww = s->ww - s->w * mw;
    double det = xx * yy - xy * xy;
    if (!(det > 0.02 * xx * yy)) {
        out->noise = 0.0;
        return false;
    }
    out->b = (xw * yy - yw * xy) / det;
    out->c = (yw * xx - xw * xy) / det;
    out->a = mw - out->b * (mx + x0) - out->c * (my + y0);
    double left = rlf_max(0.0, ww - out->b * xw - out->c * yw) / (s->count - 3);
    double variance = s->variance / s->n;
    const double cov[3] = {yy / det, -xy / det, xx / det};
    out->noise = sqrt(variance);
    out->turn = rlf_low_plane_turn(out, rlf_max(left, variance), cov, mx + x0, my + y0);
    return left < most_left * variance;
}

#endif
