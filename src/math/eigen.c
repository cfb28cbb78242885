/* Eigenvectors of small symmetric matrices. */
#include "math/eigen.h"

#define SWEEPS 30

void math_eigen(double a[4][4], int32_t n, double values[4], double vectors[4][4])
{
    for (int32_t i = 0; i < n; i++) {
        for (int32_t k = 0; k < n; k++) {
            vectors[i][k] = i == k ? 1.0 : 0.0;
        }
    }
    for (int32_t turn = 0; turn < SWEEPS * n * n; turn++) {
        int32_t p = turn / n % n, q = turn % n;
        if (p >= q || a[p][q] == 0.0) {
            continue;
        }
        double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        double size = theta < 0.0 ? -theta : theta;
        double t = (theta < 0.0 ? -1.0 : 1.0) / (size + sqrt(size * size + 1.0));
        double c = 1.0 / sqrt(t * t + 1.0), s = t * c;
        for (int32_t k = 0; k < n; k++) { /* columns p and q */
            double kp = a[k][p], kq = a[k][q];
            a[k][p] = c * kp - s * kq;
            a[k][q] = s * kp + c * kq;
        }
        for (int32_t k = 0; k < n; k++) { /* rows p and q */
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
    for (int32_t i = 0; i < n; i++) {
        values[i] = a[i][i];
    }
}
