/* Figures of a distribution of angles. */
#include "eval/measures/angles.h"

#include "eval/measures/percent.h"

#define WRONG_DEG 30.0

double eval_mean_deg(const eval_angles *a)
{
    return a->count > 0 ? a->sum_deg / (double)a->count : NAN;
}

double eval_median_deg(const eval_angles *a)
{
    int64_t seen = 0;
    for (int i = 0; i < EVAL_ANGLE_BINS; i++) {
        seen += a->bins[i];
        if (2 * seen >= a->count && a->count > 0) {
            return (i + 0.5) * 180.0 / EVAL_ANGLE_BINS;
        }
    }
    return NAN;
}

double eval_wrong_percent(const eval_angles *a)
{
    return eval_percent(a->wrong, a->count);
}

double eval_missing_percent(const eval_angles *a)
{
    return eval_percent(a->missing, a->count + a->missing);
}

double eval_within_percent(const eval_angles *a, double degrees)
{
    int64_t within = 0;
    for (int i = 0; i < (int)(degrees * EVAL_ANGLE_BINS / 180.0); i++) {
        within += a->bins[i];
    }
    return eval_percent(within, a->count);
}

void eval_add_angle(eval_angles *a, double degrees)
{
    int bin = (int)(degrees * EVAL_ANGLE_BINS / 180.0);
    a->bins[bin < EVAL_ANGLE_BINS ? bin : EVAL_ANGLE_BINS - 1]++;
    a->sum_deg += degrees;
    a->count++;
    a->wrong += degrees > WRONG_DEG;
}
