/* Inverses of small matrices. */
#ifndef RLF_MATH_INVERSE_H
#define RLF_MATH_INVERSE_H

#include <stdint.h>

enum { MATH_INVERSE_MOST = 12 };

/* Inverts the symmetric positive definite n x n matrix, n <= MATH_INVERSE_MOST, in place: by
 * Cholesky's factor (Golub and Van Loan, algorithm 4.2.1). Pivots of what is not positive definite
 * are taken for 1e-12. */
void math_invert(double *a, int32_t n);

#endif
