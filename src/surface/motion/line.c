/* The velocity of a keyframe: the line through its last poses. */
#include "math/eigen.h"
#include "surface/motion/keyframe.h"

#include <string.h>

enum { LEAST_LINE = 4 }; /* frames: fewer always lie on a line */

/* Squared sum of 3 normal variables that chance exceeds once in 10000 times; the square of one that
 * it exceeds once in 100. */
static const double significant_3 = 21.1, likely_1 = 6.63;
/* Square of a slope in units of its variance in the worst direction: it is right to 5 %. */
static const double precise = 400.0;

void keyframe_push(rlf_keyframe *key, double time_s, const double x[6])
{
    if (key->ring_count == KEYFRAME_RING) {
        memmove(key->ring, key->ring + 1, (KEYFRAME_RING - 1) * sizeof *key->ring);
        key->ring_count--;
    }
    key->ring[key->ring_count].time_s = time_s;
    memcpy(key->ring[key->ring_count++].x, x, 6 * sizeof(double));
    memcpy(key->x, x, 6 * sizeof(double));
}

/* The line through the last n poses of the shift (first = 0) or the turn (3): its slope, the
 * variance of that in units of a pose's, and the squares that it leaves. */
static double fit_line(const rlf_keyframe *key, int first, int32_t n, double slope[3],
                       double *variance)
{
    const keyframe_pose *pose = &key->ring[key->ring_count - n];
    double times = 0.0, square = 0.0, left = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double t = pose[k].time_s - pose[n - 1].time_s;
        times += t;
        square += t * t;
    }
    square -= times * times / n;
    for (int c = first; c < first + 3; c++) {
        double sum = 0.0, by_time = 0.0, squares = 0.0;
        for (int32_t k = 0; k < n; k++) {
            const double x = pose[k].x[c] - pose[n - 1].x[c];
            sum += x;
            by_time += x * (pose[k].time_s - pose[n - 1].time_s);
            squares += x * x;
        }
        by_time -= sum * times / n;
        slope[c - first] = by_time / square;
        left += (squares - sum * sum / n - by_time * by_time / square) / key->spread[c][c];
    }
    *variance = 1.0 / square;
    return left;
}

/* Of a slope with a covariance so many times that of poses, the directions in which it is not
 * chance; nothing, unless all of it is not. */
static void keep_significant(const rlf_keyframe *key, int first, const double slope[3],
                             double variance, double out[3])
{
    double c[6][6] = {{0.0}}, value[6], axis[6][6], sum = 0.0;
    for (int i = 0; i < 3; i++) {
        memcpy(c[i], key->spread[first + i] + first, 3 * sizeof(double));
        out[i] = 0.0;
    }
    math_eigen(c, 3, value, axis);
    for (int e = 0; e < 3; e++) {
        const double v = slope[0] * axis[0][e] + slope[1] * axis[1][e] + slope[2] * axis[2][e];
        const double squares = v * v / (value[e] * variance);
        sum += squares;
        for (int i = 0; i < 3 && squares > likely_1; i++) {
            out[i] += v * axis[i][e];
        }
    }
    if (sum < significant_3) {
        memset(out, 0, 3 * sizeof(double));
    }
}

/* The slope over as few frames as tell it well, or as many as it is a line. */
static void measure(rlf_keyframe *key, int first)
{
    double slope[3] = {0}, best[3] = {0}, variance, of_best = 1.0;
    bool is_precise = false;
    for (int32_t n = 2; n <= key->ring_count && !is_precise; n++) {
        double length = 0.0, worst = 0.0;
        const double left = fit_line(key, first, n, slope, &variance);
        if (n >= LEAST_LINE && left > significant_3 + 3.0 * (n - 2)) {
            break;
        }
        for (int c = 0; c < 3; c++) {
            length += slope[c] * slope[c];
            worst = rlf_max(worst, key->spread[first + c][first + c]);
        }
        is_precise = length > precise * worst * variance;
        memcpy(best, slope, sizeof(best));
        of_best = variance;
    }
    keep_significant(key, first, best, of_best, key->velocity + first);
}

void keyframe_measure_velocity(rlf_keyframe *key)
{
    measure(key, 0);
    measure(key, 3);
}
