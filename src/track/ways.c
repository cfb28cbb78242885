/* Ways of a motion: depth's own, then those of depth and brightness together. */
#include "track/ways.h"

#include "math/eigen.h"

#include <string.h>

#define SHARED 8.0 /* 64 points in a square share an error: a mean is so many times worse */
/* Where depth is that good (a quarter of a voxel) brightness says nothing; where it is twice as
 * bad, all that it can. */
#define NEEDED_M 0.0015

enum { EVERY = 4 }; /* point along rows and columns tells where they lie */

double track_reach_of(const track_points *points)
{
    double count = 0.0, sum = 0.0;
    for (int32_t y = 0; y < points->height; y += EVERY) {
        for (int32_t x = 0; x < points->width; x += EVERY) {
            const size_t i = (size_t)y * (size_t)points->width + (size_t)x;
            const rlf_vec3 p = {(double)points->x[i], (double)points->y[i], (double)points->z[i]};
            sum += p.z > 0.0 ? rlf_dot(p, p) : 0.0;
            count += p.z > 0.0;
        }
    }
    return count > 0.0 ? sqrt(sum / count) : 1.0;
}

double track_along(const track_ways *ways, int k, const double motion[6])
{
    const double square = ways->reach * ways->reach;
    double sum = 0.0;
    for (int i = 0; i < 6; i++) {
        sum += (i < 3 ? square : 1.0) * ways->way[k][i] * motion[i];
    }
    return sum;
}

double track_error(const track_ways *ways, int k)
{
    return SHARED * ways->sigma / sqrt(rlf_max(ways->information[k], 1e-12));
}

/* The information about two motions, and what is said of one. */
static double between(const double a[21], const double p[6], const double q[6])
{
    double sum = 0.0;
    for (int i = 0; i < 36; i++) {
        sum += p[i / 6] * track_entry(a, i / 6, i % 6) * q[i % 6];
    }
    return sum;
}

static double pull_along(const double way[6], const double b[6])
{
    double sum = 0.0;
    for (int i = 0; i < 6; i++) {
        sum += way[i] * b[i];
    }
    return sum;
}

/* Turns the ways so that no two of them have to do with each other in `a`, which is destroyed. */
static void part(track_ways *w, double a[6][6])
{
    double vectors[6][6], old[6][6], pull[6];
    memcpy(old, w->way, sizeof(old));
    memcpy(pull, w->pull, sizeof(pull));
    math_eigen(a, 6, w->information, vectors);
    for (int k = 0; k < 6; k++) {
        w->pull[k] = 0.0;
        memset(w->way[k], 0, sizeof(w->way[k]));
        for (int i = 0; i < 6; i++) {
            w->pull[k] += vectors[i][k] * pull[i];
            for (int r = 0; r < 6; r++) {
                w->way[k][r] += vectors[i][k] * old[i][r];
            }
        }
    }
}

/* Depth alone. */
static track_ways depth_ways(const track_sums *sums, double reach, double sigma)
{
    track_ways w = {.reach = reach, .sigma = sigma};
    double a[6][6];
    for (int k = 0; k < 6; k++) {
        w.way[k][k] = k < 3 ? 1.0 / reach : 1.0;
        w.pull[k] = w.way[k][k] * sums->depth.b[k];
    }
    for (int i = 0; i < 36; i++) {
        a[i / 6][i % 6] = between(sums->depth.a, w.way[i / 6], w.way[i % 6]);
    }
    part(&w, a);
    return w;
}

track_ways track_ways_of(const track_sums *sums, double reach, double sigma)
{
    track_ways w = depth_ways(sums, reach, sigma);
    double open[6], a[6][6] = {{0}};
    for (int k = 0; k < 6; k++) {
        open[k] = rlf_clamp(track_error(&w, k) / NEEDED_M - 1.0, 0.0, 1.0);
        w.asks_grey = w.asks_grey || open[k] > 0.0;
        w.pull[k] += open[k] * pull_along(w.way[k], sums->grey.b);
        a[k][k] = w.information[k];
    }
    if (!w.asks_grey || !(sums->grey_weight > 0.0)) {
        return w;
    }
    for (int i = 0; i < 36; i++) {
        const double both = open[i / 6] * open[i % 6];
        if (both > 0.0) {
            a[i / 6][i % 6] += both * between(sums->grey.a, w.way[i / 6], w.way[i % 6]);
        }
    }
    part(&w, a);
    return w;
}
