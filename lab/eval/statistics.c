/* Student's confidence interval. */
#include "eval/statistics.h"

#include <math.h>

/* Two-sided 95 % quantiles of Student's t for 1 to 30 degrees of freedom. */
static const double quantiles[30] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                     2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
                                     2.110,  2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064,
                                     2.060,  2.056, 2.052, 2.048, 2.045, 2.042};

statistics statistics_of(const double *values, int32_t count)
{
    statistics s = {0, 0.0, NAN};
    for (int32_t i = 0; i < count; i++) {
        if (!isnan(values[i])) {
            s.mean += values[i];
            s.count++;
        }
    }
    s.mean = s.count > 0 ? s.mean / s.count : NAN;
    if (s.count < 2) {
        return s;
    }
    double square_sum = 0.0;
    for (int32_t i = 0; i < count; i++) {
        double d = isnan(values[i]) ? 0.0 : values[i] - s.mean;
        square_sum += d * d;
    }
    int32_t freedom = s.count - 1;
    double t = freedom <= 30 ? quantiles[freedom - 1] : 1.960 + 2.5 / freedom; /* within 0.002 */
    s.half_width = t * sqrt(square_sum / freedom / s.count);
    return s;
}
