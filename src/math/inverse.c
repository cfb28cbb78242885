#include "math/inverse.h"

#include <math.h>

static void factor(const double *a, int32_t n, double l[][MATH_INVERSE_MOST])
{
    for (int32_t i = 0; i < n; i++) {
        for (int32_t j = 0; j <= i; j++) {
            double s = a[i * n + j];
            for (int32_t k = 0; k < j; k++) {
                s -= l[i][k] * l[j][k];
            }
            l[i][j] = i == j ? sqrt(s > 1e-12 ? s : 1e-12) : s / l[j][j];
        }
    }
}

void math_invert(double *a, int32_t n)
{
    double l[MATH_INVERSE_MOST][MATH_INVERSE_MOST] = {{0.0}};
    double inverse[MATH_INVERSE_MOST][MATH_INVERSE_MOST] = {{0.0}};
    factor(a, n, l);
    for (int32_t c = 0; c < n; c++) {
        for (int32_t i = c; i < n; i++) {
            double s = i == c ? 1.0 : 0.0;
            for (int32_t k = c; k < i; k++) {
                s -= l[i][k] * inverse[k][c];
            }
            inverse[i][c] = s / l[i][i];
        }
    }
    for (int32_t r = 0; r < n; r++) {
        for (int32_t c = 0; c < n; c++) {
            double s = 0.0;
            for (int32_t k = r > c ? r : c; k < n; k++) {
                s += inverse[k][r] * inverse[k][c];
            }
            a[r * n + c] = s;
        }
    }
}
