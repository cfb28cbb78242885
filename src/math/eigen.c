/* Eigenvectors of small symmetric matrices. */
#include "math/eigen.h"

#include <stdbool.h>

#define SWEEPS 30
#define NOTHING 1e-20 /* beside the diagonal: turns by less than a double can hold */

static double size_of(double x)
{
    return x < 0.0 ? -x : x;
}

/* Turns rows and columns p and q until they do not mix. */
static void rotate(double a[6][6], int32_t n, int32_t p, int32_t q, double vectors[6][6])
{
    double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    double t = (theta < 0.0 ? -1.0 : 1.0) / (size_of(theta) + sqrt(theta * theta + 1.0));
    double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int32_t k = 0; k < n; k++) { /* columns */
        double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
    }
    for (int32_t k = 0; k < n; k++) { /* rows */
        double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
    }
    for (int32_t k = 0; k < n; k++) {
        double kp = vectors[k][p], kq = vectors[k][q];
        vectors[k][p] = c * kp - s * kq;
        vectors[k][q] = s * kp + c * kq;
    }
}

/* One rotation per pair that still mixes; false when none does. */
static bool sweep(double a[6][6], int32_t n, double vectors[6][6])
{
    bool has_turned = false;
    for (int32_t p = 0; p < n; p++) {
        for (int32_t q = p + 1; q < n; q++) {
            if (size_of(a[p][q]) > NOTHING * (size_of(a[p][p]) + size_of(a[q][q]))) {
                rotate(a, n, p, q, vectors);
                has_turned = true;
            }
        }
    }
    return has_turned;
}

void math_eigen(double a[6][6], int32_t n, double values[6], double vectors[6][6])
{
    for (int32_t i = 0; i < n; i++) {
        for (int32_t k = 0; k < n; k++) {
            vectors[i][k] = i == k ? 1.0 : 0.0;
        }
    }
    for (int32_t turn = 0; turn < SWEEPS && sweep(a, n, vectors); turn++) {
    }
    for (int32_t i = 0; i < n; i++) {
        values[i] = a[i][i];
    }
}
