/* The six ways in which a camera can move, and how much is known about each. */
#ifndef RLF_TRACK_WAYS_H
#define RLF_TRACK_WAYS_H

#include "track/normal_equations.h"

/* Motions (rotation vector, then translation) that are one metre long when a turn counts by how far
 * it moves what is `reach` away, at right angles to each other. What was measured says something of
 * each by itself: whoever errs about one of them need not err about another. */
typedef struct track_ways {
    double reach;          /* metres */
    double way[6][6];      /* of each: a motion */
    double information[6]; /* about each, m^-2; in no order */
    double pull[6];        /* the right side along each: pull / information is how far to go */
    double sigma;          /* of what was measured, in expected deviations */
    bool asks_grey;        /* depth leaves a way open to brightness */
} track_ways;

/* How far the points are away, RMS, metres; > 0. */
double track_reach_of(const track_points *points);
/* Brightness says something only of ways that depth leaves open. sigma: of depth's measurements, in
 * expected deviations. */
track_ways track_ways_of(const track_sums *sums, double reach, double sigma);
/* The component of a motion along a way, metres. */
double track_along(const track_ways *ways, int k, const double motion[6]);
/* Expected error along a way, metres. */
double track_error(const track_ways *ways, int k);

#endif
