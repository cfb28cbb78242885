/* Six linear equations by Cholesky (Golub and Van Loan, algorithm 4.2.1). */
#include "math/solve_six.h"

#include "relief/math.h"

void math_solve_six(double a[6][6], const double b[6], double x[6])
{
    for (int i = 0; i < 6; i++) {
        double sum = b[i];
        for (int j = 0; j <= i; j++) {
            double s = a[i][j];
            for (int k = 0; k < j; k++) {
                s -= a[i][k] * a[j][k];
            }
            a[i][j] = i == j ? sqrt(rlf_max(s, 1e-12)) : s / a[j][j];
        }
        for (int k = 0; k < i; k++) {
            sum -= a[i][k] * x[k];
        }
        x[i] = sum / a[i][i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int k = i + 1; k < 6; k++) {
            x[i] -= a[k][i] * x[k];
        }
        x[i] /= a[i][i];
    }
}
