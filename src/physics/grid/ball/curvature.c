/* The place of a bent face that a ball touches.
 *
 * With tangential offsets d from the mean point the normals are n = n_mean + K d, K the symmetric
 * matrix of curvatures. The ball's centre is c beside the mean point; a place x of the face has the
 * direction (c - x) / radius to it, which is its normal where K x = (c - x) / radius. So each of
 * K's eigenvectors has x = c / (1 + radius k) along it. */
#include "physics/grid/ball/ball.h"
#include "math/eigen.h"

#define NARROW2 2e-6 /* m^2: a patch that narrow tells no curvature */

/* In the tangent plane. */
typedef struct bend_sums {
    rlf_vec3 axes[2];
    double weight, dd[2][2], dn[2][2]; /* of offsets d from the mean point with them, and normals */
} bend_sums;

static bend_sums sums_of(const grid_patch *p, const patch_mean *mean)
{
    bend_sums sums = {.axes = {rlf_perpendicular(mean->normal)}};
    sums.axes[1] = rlf_cross(mean->normal, sums.axes[0]);
    for (int32_t i = 0; i < p->count; i++) {
        const patch_sample *s = &p->samples[i];
        double weight = patch_weight(p, s);
        if (!(weight > 0.0)) {
            continue;
        }
        rlf_vec3 off = rlf_sub(s->point, mean->point);
        sums.weight += weight;
        for (int32_t k = 0; k < 2; k++) {
            double d = weight * rlf_dot(off, sums.axes[k]);
            for (int32_t j = 0; j < 2; j++) {
                sums.dd[k][j] += d * rlf_dot(off, sums.axes[j]);
                sums.dn[k][j] += d * rlf_dot(s->cell.normal, sums.axes[j]);
            }
        }
    }
    return sums;
}

/* The curvatures by least squares, K S + S K = N + N^T with the offsets' mean squares S and their
 * mean products N with the normals: in S's own axes that is solved one by one. */
static void solve(const bend_sums *sums, double spread[2][2], double out[2][2])
{
    double square[6][6] = {{0.0}}, size[6], axes[6][6], bend[2][2];
    for (int32_t i = 0; i < 2; i++) {
        for (int32_t j = 0; j < 2; j++) {
            spread[i][j] = square[i][j] = sums->dd[i][j] / sums->weight;
        }
    }
    math_eigen(square, 2, size, axes);
    for (int32_t i = 0; i < 2; i++) {
        for (int32_t j = 0; j < 2; j++) {
            double product = 0.0;
            for (int32_t k = 0; k < 4; k++) {
                int32_t a = k / 2, b = k % 2;
                double both = (sums->dn[a][b] + sums->dn[b][a]) / sums->weight;
                product += axes[a][i] * both * axes[b][j];
            }
            bend[i][j] = product / (size[i] + size[j] + 2.0 * NARROW2);
        }
    }
    for (int32_t k = 0; k < 4; k++) {
        const double *a = axes[k / 2], *b = axes[k % 2];
        out[k / 2][k % 2] = a[0] * (bend[0][0] * b[0] + bend[0][1] * b[1]) +
                            a[1] * (bend[1][0] * b[0] + bend[1][1] * b[1]);
    }
}

void patch_correct_bulge(const grid_patch *p, patch_mean *mean)
{
    double radius = p->job->body->shape.shape.radius, lift = 0.0;
    double spread[2][2], bend[2][2], matrix[6][6] = {{0.0}}, curvature[6], ways[6][6];
    bend_sums sums = sums_of(p, mean);
    solve(&sums, spread, bend);
    for (int32_t k = 0; k < 4; k++) {
        matrix[k / 2][k % 2] = bend[k / 2][k % 2];
    }
    math_eigen(matrix, 2, curvature, ways);
    rlf_vec3 off = rlf_sub(p->centre, mean->point), normal = mean->normal;
    for (int32_t k = 0; k < 2; k++) {
        double x = ways[0][k], y = ways[1][k], bulge = rlf_max(0.0, curvature[k]);
        rlf_vec3 way = rlf_mad(rlf_scale(sums.axes[0], x), sums.axes[1], y);
        double touched = rlf_dot(off, way) / (1.0 + radius * bulge);
        double spread2 = x * x * spread[0][0] + 2.0 * x * y * spread[0][1] + y * y * spread[1][1];
        normal = rlf_mad(normal, way, bulge * touched);
        /* the touching point stands above the mean of a bulge, its plane above the point */
        lift += 0.5 * bulge * (spread2 + touched * touched);
    }
    mean->normal = rlf_normalize(normal);
    mean->point = rlf_mad(mean->point, mean->normal, lift);
}
