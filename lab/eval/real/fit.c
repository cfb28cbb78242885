/* The baselines' tools. */
#include "eval/real/fit.h"

#define DRAWS 200
#define SIGMAS 3.0
#define SAMPLES 4000 /* points that each draw is judged by */
#define POINTS_MIN 100
#define WINDOW 2 /* pixels to each side */
#define WINDOW_MIN 6

/* Sums of a linear fit 1/z = a x + b y + c over rays: exact for planes. */
typedef struct fit_sums {
    double m[6], v[3]; /* xx xy x yy y 1; times 1/z */
} fit_sums;

static void add_point(fit_sums *s, double x, double y, double inverse)
{
    const double m[6] = {x * x, x * y, x, y * y, y, 1.0}, v[3] = {x, y, 1.0};
    for (int k = 0; k < 6; k++) {
        s->m[k] += m[k];
    }
    for (int k = 0; k < 3; k++) {
        s->v[k] += v[k] * inverse;
    }
}

/* Cramer's rule. (a, b, c).p = 1 on the plane. */
static bool solve(const fit_sums *s, real_plane *out)
{
    rlf_vec3 r0 = {s->m[0], s->m[1], s->m[2]}, r1 = {s->m[1], s->m[3], s->m[4]};
    rlf_vec3 r2 = {s->m[2], s->m[4], s->m[5]}, v = {s->v[0], s->v[1], s->v[2]};
    double determinant = rlf_dot(r0, rlf_cross(r1, r2));
    if (!(determinant > 1e-18 * s->m[5])) {
        return false;
    }
    rlf_vec3 g = {rlf_dot(v, rlf_cross(r1, r2)), rlf_dot(r0, rlf_cross(v, r2)),
                  rlf_dot(r0, rlf_cross(r1, v))};
    double length = rlf_length(g);
    out->n = rlf_scale(g, -1.0 / length);
    out->d = -determinant / length;
    return length > 0.0;
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static bool is_usable(const real_points *p, const uint8_t *is_free, int32_t i)
{
    return p->depth[i] > 0.0f && (is_free == NULL || is_free[i]);
}

bool real_plane_holds(const real_points *p, const real_plane *plane, const rlf_depth_noise *noise,
                      int32_t i)
{
    double off = rlf_dot(plane->n, real_point(p, i)) - plane->d;
    double most = SIGMAS * rlf_depth_noise_sigma(noise, p->depth[i]);
    return off < most && off > -most;
}

/* Through three points. */
static bool draw_plane(const real_points *p, const int32_t *samples, int32_t count,
                       uint32_t *random, real_plane *out)
{
    rlf_vec3 a[3];
    for (int k = 0; k < 3; k++) {
        a[k] = real_point(p, samples[next_random(random) % (uint32_t)count]);
    }
    rlf_vec3 n = rlf_cross(rlf_sub(a[1], a[0]), rlf_sub(a[2], a[0]));
    double length = rlf_length(n);
    if (!(length > 1e-6)) {
        return false;
    }
    out->n = rlf_scale(n, rlf_dot(n, a[0]) > 0.0 ? -1.0 / length : 1.0 / length);
    out->d = rlf_dot(out->n, a[0]);
    return true;
}

static void refine(const real_points *p, const uint8_t *is_free, const rlf_depth_noise *noise,
                   real_plane *plane)
{
    for (int pass = 0; pass < 2; pass++) {
        fit_sums sums = {{0}, {0}};
        plane->inliers = 0;
        for (int32_t i = 0; i < p->width * p->height; i++) {
            if (is_usable(p, is_free, i) && real_plane_holds(p, plane, noise, i)) {
                add_point(&sums, p->ray_x[i], p->ray_y[i], 1.0 / p->depth[i]);
                plane->inliers++;
            }
        }
        (void)solve(&sums, plane);
    }
}

bool real_plane_find(const real_points *p, const uint8_t *is_free, const rlf_depth_noise *noise,
                     real_plane *out)
{
    int32_t samples[SAMPLES], pixels = p->width * p->height, usable = 0, count = 0;
    for (int32_t i = 0; i < pixels; i++) {
        usable += is_usable(p, is_free, i);
    }
    int32_t every = usable / SAMPLES + 1, seen = 0;
    for (int32_t i = 0; i < pixels && usable >= POINTS_MIN; i++) {
        if (is_usable(p, is_free, i) && seen++ % every == 0) {
            samples[count++] = i;
        }
    }
    uint32_t random = 1;
    out->inliers = 0;
    for (int draw = 0; draw < DRAWS && count > 0; draw++) {
        real_plane plane = {.inliers = 0};
        if (!draw_plane(p, samples, count, &random, &plane)) {
            continue;
        }
        for (int32_t k = 0; k < count; k++) {
            plane.inliers += real_plane_holds(p, &plane, noise, samples[k]);
        }
        *out = plane.inliers > out->inliers ? plane : *out;
    }
    if (out->inliers > 0) {
        refine(p, is_free, noise, out);
    }
    return out->inliers > 0;
}

rlf_vec3 real_window_normal(const real_points *p, int32_t i)
{
    int32_t x = i % p->width, y = i / p->width, count = 0;
    fit_sums sums = {{0}, {0}};
    real_plane plane = {.inliers = 0};
    if (x < WINDOW || y < WINDOW || x >= p->width - WINDOW || y >= p->height - WINDOW) {
        return rlf_vec3_make(0, 0, 0);
    }
    for (int32_t dy = -WINDOW; dy <= WINDOW; dy++) {
        for (int32_t dx = -WINDOW; dx <= WINDOW; dx++) {
            int32_t j = i + dy * p->width + dx;
            if (p->depth[j] > 0.0f) {
                /* About the window's middle: the sums stay well conditioned. */
                add_point(&sums, p->ray_x[j] - p->ray_x[i], p->ray_y[j] - p->ray_y[i],
                          1.0 / p->depth[j]);
                count++;
            }
        }
    }
    if (count < WINDOW_MIN || !solve(&sums, &plane)) {
        return rlf_vec3_make(0, 0, 0);
    }
    rlf_vec3 n = plane.n;
    n.z -= n.x * p->ray_x[i] + n.y * p->ray_y[i];
    return rlf_normalize(n);
}
