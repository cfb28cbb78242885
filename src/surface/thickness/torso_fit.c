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

/* Normal equations of the correction x: J x = -distance. */
typedef struct equations {
    double a[N][N], b[N];
    int first, end; /* of the unknowns that are asked for */
    double weight;  /* of a point that fits, 1/m^2 */
    double misfit;
    int32_t count, fitting;
} equations;

static void add_touch(const rlf_torso_touch *touch, double weight, equations *sum)
{
    for (int r = sum->first; r < sum->end; r++) {
        double part = weight * touch->slope[r];
        if (part == 0.0) { /* what this part of the torso does not hang on */
            continue;
        }
        sum->b[r] -= part * touch->distance;
        for (int c = sum->first; c <= r; c++) {
            sum->a[r][c] += part * touch->slope[c];
        }
    }
}

/* How much something counts that is so far off the surface. */
static double share_at(double distance)
{
    double scale = distance > 0.0 ? outside_m : inside_m, off = distance / scale;
    return 1.0 / (1.0 + off * off);
}

static void add_point(const rlf_torso *torso, rlf_vec3 p, equations *sum)
{
    rlf_torso_touch touch;
    if (!rlf_torso_touch_at(torso, p, &touch)) {
        return;
    }
    double share = share_at(touch.distance);
    sum->misfit += 1.0 - share;
    sum->count++;
    sum->fitting += share > 0.5;
    add_touch(&touch, sum->weight * share * share, sum);
}

/* An outline that lies elsewhere in depth than the trunk's is an arm's. */
static void add_rim(const rlf_torso *torso, rlf_vec3 p, equations *sum)
{
    rlf_torso_touch touch;
    double moved;
    if (rlf_torso_touch_rim(torso, p, &touch, &moved)) {
        double off = moved / rim_apart_m, share = share_at(touch.distance) / (1.0 + off * off);
        add_touch(&touch, rim_worth * sum->weight * share * share, sum);
    }
}

/* Turns the torso about the upright axis. */
static void turn(rlf_torso *torso, double angle)
{
    double x = torso->side_x - angle * torso->side_z, z = torso->side_z + angle * torso->side_x;
    double length = sqrt(x * x + z * z);
    torso->side_x = x / length;
    torso->side_z = z / length;
}

static void correct(rlf_torso *torso, const equations *sum)
{
    double x[N];
    for (int r = 0; r < N; r++) {
        x[r] = 0.0;
        for (int c = 0; c < N; c++) {
            x[r] += sum->a[r][c] * sum->b[c];
        }
    }
    x[RLF_TORSO_TURN] = rlf_clamp(x[RLF_TORSO_TURN], -most_turn, most_turn);
    turn(torso, x[RLF_TORSO_TURN]);
    for (int r = 0; r < N; r++) {
        torso->unknown[r] += x[r];
    }
}

static void add_points(const rlf_torso *torso, const rlf_torso_points *points, int first, int end,
                       equations *sum)
{
    *sum = (equations){.first = first, .end = end, .weight = weight_m4 * points->area_m2};
    for (int32_t i = 0; i < points->count; i++) {
        add_point(torso, points->p[i], sum);
    }
    for (int32_t i = 0; i < points->rim_count; i++) {
        add_rim(torso, points->rim[i], sum);
    }
}

/* Turns it towards the points, its measures kept. */
static void find_turn(rlf_torso *torso, const rlf_torso_points *points, double expected)
{
    const int k = RLF_TORSO_TURN;
    equations sum;
    add_points(torso, points, k, k + 1, &sum);
    double information = 1.0 / torso->doubt[k][k];
    double by =
        (sum.b[k] + information * (expected - torso->unknown[k])) / (sum.a[k][k] + information);
    by = rlf_clamp(by, -most_turn, most_turn);
    turn(torso, by);
    torso->unknown[k] += by;
}

void rlf_torso_improve(rlf_torso *torso, const rlf_torso_points *points, int32_t passes)
{
    double information[N][N], expected[N];
    equations sum = {.count = 0};
    turn(torso, torso->unknown[RLF_TORSO_TURN]);
    torso->unknown[RLF_TORSO_TURN] = 0.0;
    memcpy(expected, torso->unknown, sizeof expected);
    memcpy(information, torso->doubt, sizeof information);
    math_invert(&information[0][0], N);
    for (int32_t pass = 0; pass < passes; pass++) {
        find_turn(torso, points, expected[RLF_TORSO_TURN]);
        add_points(torso, points, 0, N, &sum);
        for (int r = 0; r < N; r++) {
            for (int c = 0; c < N; c++) {
                sum.a[r][c] = information[r][c] + (c <= r ? sum.a[r][c] : sum.a[c][r]);
                double off = expected[c] - torso->unknown[c];
                sum.b[r] += c == RLF_TORSO_TURN ? 0.0 : information[r][c] * off;
            }
        }
        math_invert(&sum.a[0][0], N);
        correct(torso, &sum);
    }
    memcpy(torso->doubt, sum.a, sizeof torso->doubt);
    torso->misfit = sum.count >= LEAST_POINTS ? sum.misfit / sum.count : 1.0;
    torso->area_m2 = sum.fitting * points->area_m2;
}
