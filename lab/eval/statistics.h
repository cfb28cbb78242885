/* Mean of a few repeats and how well it is known. */
#ifndef RELIEF_LAB_STATISTICS_H
#define RELIEF_LAB_STATISTICS_H

#include <stdint.h>

typedef struct statistics {
    int32_t count;     /* of values that are numbers */
    double mean;       /* NAN without values */
    double half_width; /* of the 95 % confidence interval of the mean; NAN below two values */
} statistics;

/* Student's t over the values that are not NAN. */
statistics statistics_of(const double *values, int32_t count);

#endif
