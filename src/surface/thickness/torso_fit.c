/* The torso that explains a frame's points.
 *
 * Whatever is seen is on the torso or before it: a point within it is an error of the torso, one
 * outside may be on an arm, and counts the less the farther it is (Geman and McClure's weight, of
 * two scales). */
#include "surface/thickness/torso.h"

#include "math/inverse.h"

#include <math.h>
#include <string.h>

enum { N = RLF_TORSO_UNKNOWNS, LEAST_POINTS = 40 };

static const double outside_m = 0.015, inside_m = 0.05; /* scales of the weight */
/* Patches of 10 cm2 are right to 6 cm together: they share the errors of the solid. */
static const double weight_m4 = 1.0 / (0.06 * 0.06 * 0.001);
/* Points that a place on the rim is worth: it is right to a pixel, whatever the solid's shape. */
static const double rim_worth = 12.0;
static const double rim_apart_m = 0.04; /* in depth: what is as far off counts half */
static const double most_turn = 0.3;    /* rad, in one pass */

/* What a frame's points say. */
typedef struct reading {
    rlf_kernel_equations sum;
    double weight; /* of a point that fits, 1/m^2 */
    double misfit;
    int32_t count, fitting;
    bool is_turn; /* only that is asked for */
} reading;

/* How much something counts that is so far off the surface. */
static double share_at(double distance)
{
    double scale = distance > 0.0 ? outside_m : inside_m, off = distance / scale;
    return 1.0 / (1.0 + off * off);
}

static void add_touches(const rlf_kernel_touches *touches, const double *weight, int32_t count,
                        reading *to)
{
    const int k = RLF_TORSO_TURN;
    if (!to->is_turn) {
        rlf_kernel_add_touches(touches, weight, count, &to->sum);
        return;
    }
    for (int32_t i = 0; i < count; i++) {
        double part = weight[i] * touches->slope[k][i];
        to->sum.b[k] -= part * touches->distance[i];
        to->sum.a[k][k] += part * touches->slope[k][i];
    }
}

static void add_points(const rlf_torso *torso, const rlf_vec3 *p, int32_t count, reading *to)
{
    rlf_kernel_touches touches;
    double weight[RLF_KERNEL_RAYS];
    rlf_torso_touch(torso, p, count, &touches);
    for (int32_t i = 0; i < count; i++) {
        double share = share_at(touches.distance[i]);
        bool is_any = touches.is_any[i] > 0.0;
        to->misfit += is_any ? 1.0 - share : 0.0;
        to->count += is_any;
        to->fitting += is_any && share > 0.5;
        weight[i] = is_any ? to->weight * share * share : 0.0;
    }
    add_touches(&touches, weight, count, to);
}

/* An outline that lies elsewhere in depth than the trunk's is an arm's. */
static void add_rim(const rlf_torso *torso, const rlf_vec3 *p, int32_t count, reading *to)
{
    rlf_kernel_touches touches;
    double weight[RLF_KERNEL_RAYS], moved[RLF_KERNEL_RAYS];
    rlf_torso_touch_rim(torso, p, count, &touches, moved);
    for (int32_t i = 0; i < count; i++) {
        double off = moved[i] / rim_apart_m;
        double share = share_at(touches.distance[i]) / (1.0 + off * off);
        weight[i] = touches.is_any[i] > 0.0 ? rim_worth * to->weight * share * share : 0.0;
    }
    add_touches(&touches, weight, count, to);
}

/* Turns the torso about the upright axis. */
static void turn(rlf_torso *torso, double angle)
{
    double x = torso->side_x - angle * torso->side_z, z = torso->side_z + angle * torso->side_x;
    double length = sqrt(x * x + z * z);
    torso->side_x = x / length;
    torso->side_z = z / length;
}

static void correct(rlf_torso *torso, double covariance[N][N], const double b[N])
{
    double x[N];
    for (int r = 0; r < N; r++) {
        x[r] = 0.0;
        for (int c = 0; c < N; c++) {
            x[r] += covariance[r][c] * b[c];
        }
    }
    x[RLF_TORSO_TURN] = rlf_clamp(x[RLF_TORSO_TURN], -most_turn, most_turn);
    turn(torso, x[RLF_TORSO_TURN]);
    for (int r = 0; r < N; r++) {
        torso->unknown[r] += x[r];
    }
}

static int32_t batch_at(int32_t first, int32_t count)
{
    return count - first < RLF_KERNEL_RAYS ? count - first : RLF_KERNEL_RAYS;
}

static void read_points(const rlf_torso *torso, const rlf_torso_points *points, bool is_turn,
                        reading *out)
{
    *out = (reading){.is_turn = is_turn, .weight = weight_m4 * points->area_m2};
    for (int32_t i = 0; i < points->count; i += RLF_KERNEL_RAYS) {
        add_points(torso, points->p + i, batch_at(i, points->count), out);
    }
    for (int32_t i = 0; i < points->rim_count; i += RLF_KERNEL_RAYS) {
        add_rim(torso, points->rim + i, batch_at(i, points->rim_count), out);
    }
}

/* Turns it towards the points, its measures kept. */
static void find_turn(rlf_torso *torso, const rlf_torso_points *points, double expected)
{
    const int k = RLF_TORSO_TURN;
    reading r;
    read_points(torso, points, true, &r);
    double information = 1.0 / torso->doubt[k][k];
    double by =
        (r.sum.b[k] + information * (expected - torso->unknown[k])) / (r.sum.a[k][k] + information);
    by = rlf_clamp(by, -most_turn, most_turn);
    turn(torso, by);
    torso->unknown[k] += by;
}

void rlf_torso_improve(rlf_torso *torso, const rlf_torso_points *points, int32_t passes)
{
    double information[N][N], covariance[N][N] = {{0.0}}, expected[N];
    reading read = {.count = 0};
    turn(torso, torso->unknown[RLF_TORSO_TURN]);
    torso->unknown[RLF_TORSO_TURN] = 0.0;
    memcpy(expected, torso->unknown, sizeof expected);
    memcpy(information, torso->doubt, sizeof information);
    math_invert(&information[0][0], N);
    for (int32_t pass = 0; pass < passes; pass++) {
        find_turn(torso, points, expected[RLF_TORSO_TURN]);
        read_points(torso, points, false, &read);
        rlf_kernel_equations *sum = &read.sum;
        for (int r = 0; r < N; r++) {
            for (int c = 0; c < N; c++) {
                covariance[r][c] = information[r][c] + (c <= r ? sum->a[r][c] : sum->a[c][r]);
                double off = expected[c] - torso->unknown[c];
                sum->b[r] += c == RLF_TORSO_TURN ? 0.0 : information[r][c] * off;
            }
        }
        math_invert(&covariance[0][0], N);
        correct(torso, covariance, sum->b);
    }
    memcpy(torso->doubt, covariance, sizeof torso->doubt);
    torso->misfit = read.count >= LEAST_POINTS ? read.misfit / read.count : 1.0;
    torso->area_m2 = read.fitting * points->area_m2;
}
