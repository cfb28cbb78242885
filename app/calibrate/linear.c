/* Cholesky's inverse. */
#include "calibrate/solve.h"

#include <math.h>

/* A pivot below this share of the diagonal is rounding: the unknown is not determined. */
#define PIVOT_MIN 1e-14

/* l becomes Cholesky's lower triangle of the scaled matrix. */
static bool factor(int32_t n, const double *a, const double *scale, double *l)
{
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j <= i; j++) {
            double sum = a[i * n + j] * scale[i] * scale[j];
            for (int32_t k = 0; k < j; k++) {
                sum -= l[i * n + k] * l[j * n + k];
            }
            if (i == j && !(sum > PIVOT_MIN)) {
                return false;
            }
            l[i * n + j] = i == j ? sqrt(sum) : sum / l[j * n + j];
        }
    }
    return true;
}

/* Column `c` of the inverse of L L^T. */
static void solve_unit(int32_t n, const double *l, int32_t c, double *x)
{
    for (int32_t i = 0; i < n; i++) {
        double sum = i == c ? 1.0 : 0.0;
        for (int32_t k = 0; k < i; k++) {
            sum -= l[i * n + k] * x[k];
        }
        x[i] = sum / l[i * n + i];
    }
    for (int32_t i = n - 1; i >= 0; i--) {
        double sum = x[i];
        for (int32_t k = i + 1; k < n; k++) {
            sum -= l[k * n + i] * x[k];
        }
        x[i] = sum / l[i * n + i];
    }
}

bool linear_invert(int32_t n, const double *a, double *out)
{
    double scale[LINEAR_MAX], l[LINEAR_MAX * LINEAR_MAX], x[LINEAR_MAX];
    for (int32_t i = 0; i < n; i++) {
        if (!(a[i * n + i] > 0.0)) {
            return false;
        }
        scale[i] = 1.0 / sqrt(a[i * n + i]);
    }
    if (!factor(n, a, scale, l)) {
        return false;
    }
    for (int32_t c = 0; c < n; c++) {
        solve_unit(n, l, c, x);
        for (int32_t i = 0; i < n; i++) {
            out[i * n + c] = x[i] * scale[i] * scale[c];
        }
    }
    return true;
}
