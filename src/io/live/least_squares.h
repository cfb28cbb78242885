/* Linear least squares with few unknowns, by normal equations. */
#ifndef RLF_IO_LIVE_LEAST_SQUARES_H
#define RLF_IO_LIVE_LEAST_SQUARES_H

#include "relief/base.h"

#define IO_UNKNOWNS_MAX 16

/* Zero but for `count` before the first row. */
typedef struct io_least_squares {
    int32_t count; /* unknowns */
    double a[IO_UNKNOWNS_MAX][IO_UNKNOWNS_MAX];
    double b[IO_UNKNOWNS_MAX];
} io_least_squares;

/* One equation: the sum of row[i] x[i] is `value`. */
void io_least_squares_add(io_least_squares *ls, const double *row, double value);

/* Writes the `count` unknowns; false when the rows do not determine them. Uses *ls up. */
bool io_least_squares_solve(io_least_squares *ls, double *out);

#endif
