#include "math/observe.h"

#include "math/inverse.h"

void math_observe(double *value, double *covariance, int32_t n, const math_observation *seen)
{
    double gain[MATH_INVERSE_MOST], off = seen->value - value[seen->k];
    double sum = covariance[seen->k * n + seen->k] + seen->variance;
    for (int32_t r = 0; r < n; r++) {
        gain[r] = covariance[r * n + seen->k] / sum;
    }
    for (int32_t r = 0; r < n; r++) {
        value[r] += gain[r] * off;
        for (int32_t c = 0; c < n; c++) {
            covariance[r * n + c] -= gain[r] * gain[c] * sum;
        }
    }
}
