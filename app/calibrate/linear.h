/* Symmetric positive definite systems of the sizes that calibration has. */
#ifndef RELIEF_APP_CALIBRATE_LINEAR_H
#define RELIEF_APP_CALIBRATE_LINEAR_H

#include <stdbool.h>
#include <stdint.h>

#define LINEAR_MAX 24

/* Inverse of the n x n matrix `a` (rows of n numbers), n <= LINEAR_MAX, by Cholesky's L L^T with
 * rows scaled to a unit diagonal. False, and `out` not set, when it is not positive definite. */
bool linear_invert(int32_t n, const double *a, double *out);

#endif
