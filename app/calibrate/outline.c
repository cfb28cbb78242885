/* Depth steps along the board's sides, a line through each side's, corners where lines meet. */
#include "calibrate/calibrate.h"

#include <math.h>

#define SAMPLES 64       /* along a side */
#define SIDE_MARGIN 0.08 /* of a side's ends are left out: corners are round in depth */
#define SEARCH_SHARE 0.2 /* of the board's smaller side, on both sides of where it should be */
#define SAMPLES_LEAST 24 /* of a side's samples that must have an edge */
#define TRIM_ROUNDS 3
#define TRIM_RATIO 2.5     /* of the RMS: places beyond belong to something else */
#define SIGMA_LEAST_PX 0.3 /* an edge between two pixels */

typedef struct board_plane {
    rlf_vec3 normal;
    double distance; /* n . p = distance */
} board_plane;

/* A line n . (u, v) = d with unit n. */
typedef struct line {
    double n[2], d;
} line;

typedef struct place {
    double u, v;
    bool is_in;
} place;

/* A pixel of the board: its depth is that of the plane to within its noise, and a share for the
 * plane's own error. */
static bool is_board(const rlf_rig *rig, const board_plane *plane, const float *depth, double u,
                     double v)
{
    const int32_t x = (int32_t)floor(u + 0.5), y = (int32_t)floor(v + 0.5);
    rlf_vec3 ray;
    if (x < 0 || y < 0 || x >= rig->depth.width || y >= rig->depth.height ||
        !rlf_camera_unproject(&rig->depth, x, y, &ray)) {
        return false;
    }
    const double z = depth[(int64_t)y * rig->depth.width + x];
    const double should = plane->distance / rlf_dot(plane->normal, ray);
    const double tolerance = 4.0 * rlf_depth_noise_sigma(&rig->noise, should) + 0.01 * should;
    return z > 0.0 && fabs(z - should) < tolerance;
}

/* Where the board ends on the way from `from` outwards to `to` (metres in its plane): the middle
 * between its last pixel and the first beyond. */
static bool find_end(const rlf_rig *rig, const rlf_pose *T, const board_plane *plane,
                     const float *depth, const double from[2], const double to[2], place *out)
{
    double a[2], b[2];
    const bool is_seen =
        rlf_camera_project(&rig->depth, rlf_transform(T, rlf_vec3_make(from[0], from[1], 0)), &a[0],
                           &a[1]) &&
        rlf_camera_project(&rig->depth, rlf_transform(T, rlf_vec3_make(to[0], to[1], 0)), &b[0],
                           &b[1]);
    const double length = is_seen ? hypot(b[0] - a[0], b[1] - a[1]) : 0.0;
    const int steps = (int)(4.0 * length); /* a quarter of a pixel each */
    double last = -1.0;
    for (int i = 0; i <= steps; i++) {
        const double t = (double)i / steps;
        if (is_board(rig, plane, depth, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))) {
            last = t;
        } else if (last >= 0.0 && (t - last) * length > 2.0) {
            break; /* two pixels beyond: it is over, not a hole */
        }
    }
    rlf_vec3 ray;
    const double end = last + 0.5 / (steps > 0 ? steps : 1);
    if (last < 0.0 || end >= 1.0 - 2.0 / rlf_max(length, 2.0) ||
        !rlf_camera_unproject(&rig->depth, a[0] + end * (b[0] - a[0]), a[1] + end * (b[1] - a[1]),
                              &ray)) {
        return false;
    }
    *out =
        (place){rig->depth.fx * ray.x + rig->depth.cx, rig->depth.fy * ray.y + rig->depth.cy, true};
    return true;
}

/* Total least squares through the places that are in; returns their RMS distance. */
static double fit_line(const place *places, int32_t count, line *out)
{
    double n = 0, su = 0, sv = 0, uu = 0, uv = 0, vv = 0;
    for (int32_t i = 0; i < count; i++) {
        if (places[i].is_in) {
            n++;
            su += places[i].u;
            sv += places[i].v;
        }
    }
    su /= n;
    sv /= n;
    for (int32_t i = 0; i < count; i++) {
        const double u = places[i].u - su, v = places[i].v - sv;
        uu += places[i].is_in ? u * u : 0.0;
        uv += places[i].is_in ? u * v : 0.0;
        vv += places[i].is_in ? v * v : 0.0;
    }
    const double angle = 0.5 * rlf_atan2(2.0 * uv, uu - vv); /* of the line's direction */
    out->n[0] = -rlf_sin(angle);
    out->n[1] = rlf_cos(angle);
    out->d = out->n[0] * su + out->n[1] * sv;
    const double across =
        out->n[0] * out->n[0] * uu + 2.0 * out->n[0] * out->n[1] * uv + out->n[1] * out->n[1] * vv;
    return sqrt(rlf_max(across, 0.0) / n);
}

static bool fit_trimmed(place *places, int32_t count, line *out, double *out_rms)
{
    int32_t in = count;
    *out_rms = 0.0;
    for (int round = 0; round <= TRIM_ROUNDS && in >= SAMPLES_LEAST; round++) {
        *out_rms = fit_line(places, count, out);
        const double limit = rlf_max(TRIM_RATIO * *out_rms, 1.0);
        in = 0;
        for (int32_t i = 0; i < count; i++) {
            const double off = out->n[0] * places[i].u + out->n[1] * places[i].v - out->d;
            places[i].is_in = fabs(off) < limit;
            in += places[i].is_in;
        }
    }
    return in >= SAMPLES_LEAST;
}

/* Side 0 left, 1 right (x = -+ half width), 2 top, 3 bottom (y = -+ half height). */
static bool find_side(const rlf_rig *rig, const rlf_pose *T, const board_plane *plane,
                      const double size[2], const float *depth, int side, line *out,
                      double *out_rms)
{
    const int across = side / 2, along = 1 - across;
    const double sign = side % 2 == 0 ? -1.0 : 1.0;
    const double search = SEARCH_SHARE * rlf_min(size[0], size[1]);
    place places[SAMPLES];
    int32_t count = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const double t = SIDE_MARGIN + (1.0 - 2.0 * SIDE_MARGIN) * i / (SAMPLES - 1) - 0.5;
        double from[2], to[2];
        from[along] = to[along] = t * size[along];
        from[across] = sign * (0.5 * size[across] - search);
        to[across] = sign * (0.5 * size[across] + search);
        count += find_end(rig, T, plane, depth, from, to, &places[count]);
    }
    return count >= SAMPLES_LEAST && fit_trimmed(places, count, out, out_rms);
}

static bool meet(const line *a, const line *b, double out[2])
{
    const double det = a->n[0] * b->n[1] - a->n[1] * b->n[0];
    out[0] = (a->d * b->n[1] - b->d * a->n[1]) / det;
    out[1] = (a->n[0] * b->d - b->n[0] * a->d) / det;
    return fabs(det) > 0.1;
}

/* The plane of the board, moved along its normal to where depth has the middle of it. */
static board_plane find_plane(const rlf_rig *rig, const rlf_pose *T, const double size[2],
                              const float *depth)
{
    board_plane plane = {.normal = rlf_rotate(T->q, rlf_vec3_make(0, 0, 1))};
    double sum = 0.0;
    int32_t count = 0;
    for (int i = 0; i < 100; i++) {
        const rlf_vec3 p = rlf_transform(
            T, rlf_vec3_make((i % 10 - 4.5) * 0.05 * size[0], (i / 10 - 4.5) * 0.05 * size[1], 0));
        double u, v;
        rlf_vec3 ray;
        if (!rlf_camera_project(&rig->depth, p, &u, &v) || u < 0 || v < 0 ||
            u >= rig->depth.width - 1 || v >= rig->depth.height - 1) {
            continue;
        }
        const int64_t x = (int64_t)(u + 0.5), y = (int64_t)(v + 0.5);
        const double z = depth[y * rig->depth.width + x];
        if (z > 0.9 * p.z && z < 1.1 * p.z &&
            rlf_camera_unproject(&rig->depth, (double)x, (double)y, &ray)) {
            sum += z * rlf_dot(plane.normal, ray);
            count++;
        }
    }
    plane.distance = count > 0 ? sum / count : rlf_dot(plane.normal, T->p);
    return plane;
}

bool calibrate_outline(const rlf_rig *rig, const rlf_pose *T_camera_board, const double size[2],
                       const float *depth, double out[4][2], double *out_sigma)
{
    const board_plane plane = find_plane(rig, T_camera_board, size, depth);
    line sides[4];
    double squares = 0.0;
    for (int side = 0; side < 4; side++) {
        double rms;
        if (!find_side(rig, T_camera_board, &plane, size, depth, side, &sides[side], &rms)) {
            return false;
        }
        squares += rms * rms;
    }
    *out_sigma = rlf_max(sqrt(squares / 4.0), SIGMA_LEAST_PX);
    return meet(&sides[0], &sides[2], out[0]) && meet(&sides[1], &sides[2], out[1]) &&
           meet(&sides[0], &sides[3], out[2]) && meet(&sides[1], &sides[3], out[3]);
}
