/* The directions that a surface's normals are along or across (Gupta, Arbelaez, Malik 2013:
 * Perceptual organization and recognition of indoor scenes from RGB-D images: the gravity
 * direction). Floors and tables lie across up, walls and upright sides along it; so do a room's
 * other axes fit, and several starts are followed. */
#include "query/up.h"

#include "math/eigen.h"

/* Rounds with each of two angles: 45 degrees, where each normal is one or the other, then 15. */
enum { ROUNDS = 5, STARTS = 25 };

static const double along_cos[2] = {0.70710678, RLF_UP_ALONG};
static const double across_cos[2] = {0.70710678, RLF_UP_ACROSS};
static const double sure_share = 0.01; /* a direction must beat the next by this share of normals */

/* Of n n^T of the normals across, minus of those along. */
static void sum_normals(const rlf_up_samples *samples, rlf_vec3 axis, int32_t angle, double a[6][6])
{
    for (int32_t i = 0; i < samples->count; i++) {
        rlf_vec3 n = samples->normal[i];
        double c = rlf_dot(n, axis), size = c < 0.0 ? -c : c;
        bool is_across = size < across_cos[angle];
        if (!is_across && size <= along_cos[angle]) {
            continue;
        }
        const double v[3] = {n.x, n.y, n.z};
        double sign = is_across ? 1.0 : -1.0;
        for (int32_t k = 0; k < 9; k++) {
            a[k / 3][k % 3] += sign * v[k / 3] * v[k % 3];
        }
    }
}

double rlf_up_least(double a[6][6], rlf_vec3 *axis)
{
    double values[6], vectors[6][6];
    math_eigen(a, 3, values, vectors);
    int32_t best = values[1] < values[0] ? 1 : 0;
    best = values[2] < values[best] ? 2 : best;
    double next = rlf_min(values[(best + 1) % 3], values[(best + 2) % 3]);
    rlf_vec3 found = {vectors[0][best], vectors[1][best], vectors[2][best]};
    *axis = rlf_dot(found, *axis) < 0.0 ? rlf_neg(found) : found;
    return next - values[best];
}

/* Moves *axis to the direction with the least sum of squares: of cosines to normals across it and
 * sines to those along it. False when another direction does nearly as well. */
static bool improve(const rlf_up_samples *samples, int32_t angle, rlf_vec3 *axis)
{
    double a[6][6] = {{0}};
    sum_normals(samples, *axis, angle, a);
    return rlf_up_least(a, axis) > sure_share * samples->count;
}

/* Directions of half a sphere, evenly (Fibonacci's lattice; Gonzalez 2010). */
static rlf_vec3 start_at(int32_t k)
{
    const double golden_angle = 2.39996322972865332;
    double z = (k + 0.5) / STARTS, r = sqrt(1.0 - z * z), angle = golden_angle * k;
    return rlf_vec3_make(r * rlf_cos(angle), r * rlf_sin(angle), z);
}

static bool follow(const rlf_up_samples *samples, rlf_vec3 *axis)
{
    for (int32_t round = 0; round < 2 * ROUNDS; round++) {
        if (!improve(samples, round / ROUNDS, axis)) {
            return false;
        }
    }
    return true;
}

static bool is_known(const rlf_vec3 *axes, int32_t count, rlf_vec3 axis)
{
    for (int32_t k = 0; k < count; k++) {
        double c = rlf_dot(axes[k], axis);
        if (c > RLF_UP_SAME || -c > RLF_UP_SAME) {
            return true;
        }
    }
    return false;
}

int32_t rlf_up_axes(const rlf_up_samples *samples, rlf_vec3 axes[RLF_UP_AXES])
{
    int32_t count = 0;
    for (int32_t k = 0; k < STARTS && count < RLF_UP_AXES; k++) {
        rlf_vec3 axis = start_at(k);
        if (follow(samples, &axis) && !is_known(axes, count, axis)) {
            axes[count++] = axis;
        }
    }
    return count;
}
