/* Kalman's correction of a few values by one of them. */
#ifndef RLF_MATH_OBSERVE_H
#define RLF_MATH_OBSERVE_H

#include <stdint.h>

/* An observation of value k. */
typedef struct math_observation {
    int32_t k;
    double value, variance; /* variance > 0 */
} math_observation;

/* Corrects n values, n <= MATH_INVERSE_MOST, and their n x n covariance by the observation (Kalman
 * 1960). */
void math_observe(double *value, double *covariance, int32_t n, const math_observation *seen);

#endif
