/* Missing points per frame in the four cases of thesis section 5.1.2, table 5.1. */
#ifndef RELIEF_APP_MEASURE_POINTS_H
#define RELIEF_APP_MEASURE_POINTS_H

#include "relief/io.h"

/* (a) and (b): frames without a moving object; (c) and (d): frames with one. (a) and (c): the whole
 * scene; (b) and (d): its centre, 77.59 % of a 64x53 grid. */
typedef enum measure_case {
    MEASURE_STILL_FULL = 0,
    MEASURE_STILL_CENTRE = 1,
    MEASURE_MOVING_FULL = 2,
    MEASURE_MOVING_CENTRE = 3,
    MEASURE_CASE_COUNT = 4
} measure_case;

typedef struct measure_counts {
    int64_t frames;
    int64_t points;                    /* of the area, per frame */
    int64_t reasons[RLF_REASON_COUNT]; /* sums over frames */
    int64_t true_points, bad_normals;  /* where truth exists: normal missing or > 30 deg off */
} measure_counts;

typedef struct measure_points {
    int32_t width, height; /* of the grid; 0 before the first frame */
    measure_counts cases[MEASURE_CASE_COUNT];
} measure_points;

/* Name of a case as the thesis writes it, "a" to "d". */
const char *measure_case_name(measure_case c);
/* Takes one surface; frames of a background that is still being learnt are left out. truth may be
 * NULL. */
void measure_points_add(measure_points *m, const rlf_surface *surface, const rlf_truth *truth,
                        const rlf_rig *rig);

/* Mean number of points per frame that the sensor did not deliver. */
double measure_missing(const measure_counts *c);
/* The same as a share of the area's points, percent. */
double measure_missing_percent(const measure_counts *c);
/* The thesis's estimate of wrong normals: each missing point spoils its four neighbours, percent of
 * the area's points, at most all of them. */
double measure_estimated_percent(const measure_counts *c);
/* Counted against truth: normals missing or more than 30 degrees off, percent; NAN without truth.
 */
double measure_counted_percent(const measure_counts *c);

/* What the thesis's table 5.1 has for the case, missing points of its 64x53 grid; NAN for any other
 * grid. */
double measure_published(const measure_points *m, measure_case c);
/* How far the mean is from that, percent of it, with its sign; NAN without frames. */
double measure_published_off_percent(const measure_points *m, measure_case c);

#endif
