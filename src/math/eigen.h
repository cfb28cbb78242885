/* Eigenvectors of small symmetric matrices. */
#ifndef RLF_MATH_EIGEN_H
#define RLF_MATH_EIGEN_H

#include "relief/math.h"

/* Eigenvalues and unit eigenvectors (columns of `vectors`) of the leading n x n part of the
 * symmetric matrix `a`, n <= 6, which is destroyed: Jacobi's rotations (Golub and Van Loan,
 * algorithm 8.5.1), until nothing mixes. The values are in no order. */
void math_eigen(double a[6][6], int32_t n, double values[6], double vectors[6][6]);

#endif
