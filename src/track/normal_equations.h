/* Normal equations of a small motion that lays points on predicted surfaces. */
#ifndef RLF_TRACK_NORMAL_EQUATIONS_H
#define RLF_TRACK_NORMAL_EQUATIONS_H

#include "track/points.h"

/* Residuals over their expected deviation are counted in bins of 1 / TRACK_BINS_PER_SIGMA. */
#define TRACK_BINS 128
#define TRACK_BINS_PER_SIGMA 8

/* What a kind of measurement says of rotation vector, then translation, in the prediction's frame:
 * lower triangle by rows; right side. */
typedef struct track_equations {
    double a[21], b[6];
} track_equations;

static inline double track_entry(const double a[21], int row, int column)
{
    return row > column ? a[row * (row + 1) / 2 + column] : a[column * (column + 1) / 2 + row];
}

/* Sums over points. */
typedef struct track_sums {
    track_equations depth, grey;
    double information; /* sum of the weights */
    double squared;     /* of weighted residuals over their deviation */
    double weight;      /* sum of the robust weights */
    int32_t tried;      /* points of the frame that fall on a known part of the prediction, or
                           into its picture where nothing is known */
    int32_t matched;    /* points within the gate */
    int32_t bins[TRACK_BINS];
    double grey_residual, grey_weight; /* sums: the pictures' mean difference, levels */
} track_sums;

/* How points count. */
typedef struct track_gate {
    double metres;  /* farther ones do not count */
    double cut;     /* Tukey's limit, in expected deviations */
    double grey;    /* levels by which the prediction is brighter than the frame */
    bool asks_grey; /* whether brightness is summed */
} track_gate;

/* Of every `stride`-th point of every `stride`-th row. T: the frame's camera to the prediction's.
 */
track_sums track_sums_of(const track_points *points, int32_t stride,
                         const rlf_prediction *prediction, const rlf_pose *T,
                         const track_gate *gate);

#endif
