/* Linear least squares by normal equations and Cholesky's factorisation. */
#include "io/live/least_squares.h"

#include <math.h>

void io_least_squares_add(io_least_squares *ls, const double *row, double value)
{
    for (int32_t i = 0; i < ls->count; i++) {
        for (int32_t k = 0; k <= i; k++) {
            ls->a[i][k] += row[i] * row[k];
        }
        ls->b[i] += row[i] * value;
    }
}

/* The lower triangle of a becomes L with L L^T = a. */
static bool factorise(io_least_squares *ls)
{
    for (int32_t i = 0; i < ls->count; i++) {
        for (int32_t k = 0; k <= i; k++) {
            double sum = ls->a[i][k];
            for (int32_t j = 0; j < k; j++) {
                sum -= ls->a[i][j] * ls->a[k][j];
            }
            if (k < i) {
                ls->a[i][k] = sum / ls->a[k][k];
            } else if (sum > 1e-14 * ls->a[i][i]) { /* a multiple of double's rounding */
                ls->a[i][i] = sqrt(sum);
            } else {
                return false;
            }
        }
    }
    return true;
}

bool io_least_squares_solve(io_least_squares *ls, double *out)
{
    if (!factorise(ls)) {
        return false;
    }
    for (int32_t i = 0; i < ls->count; i++) {
        double sum = ls->b[i];
        for (int32_t j = 0; j < i; j++) {
            sum -= ls->a[i][j] * out[j];
        }
        out[i] = sum / ls->a[i][i];
    }
    for (int32_t i = ls->count - 1; i >= 0; i--) {
        double sum = out[i];
        for (int32_t j = i + 1; j < ls->count; j++) {
            sum -= ls->a[j][i] * out[j];
        }
        out[i] = sum / ls->a[i][i];
    }
    return true;
}
