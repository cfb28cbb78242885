/* People of the analytic room: heads, trunks and legs, of ellipsoids. */
#ifndef RELIEF_APP_BENCH_PEOPLE_H
#define RELIEF_APP_BENCH_PEOPLE_H

#include "relief/relief.h"

typedef enum people_cloth {
    PEOPLE_SKIN,
    PEOPLE_SHIRT,
    PEOPLE_TROUSERS,
    PEOPLE_SHOE,
    PEOPLE_NOBODY
} people_cloth;

/* An ellipsoid that is sheared along x: (x - lean y) and y and z, from the middle and over half its
 * extents, are on a unit ball. Seen from the camera that it was placed for. */
typedef struct people_part {
    rlf_vec3 middle, half; /* metres */
    double lean;
    double x0, x1, y0, y1; /* rays (x, y, 1) that may meet it */
    people_cloth cloth;
} people_part;

enum { PEOPLE_PARTS = 11, PEOPLE_MOST = 16 };

typedef struct people {
    people_part part[PEOPLE_MOST * PEOPLE_PARTS];
    int32_t count;
} people;

/* Adds a person of 1.76 m who stands at (x, z) of the camera frame, 1 m below it; the legs lean by
 * `stride` to both sides. */
void people_add(people *to, double x, double z, double stride);
/* The same people seen from a camera that stands so far to the right. */
void people_shift(people *p, double x);
/* Depth at which the ray meets somebody, 0 where it does not, and what it meets. */
double people_hit(const people *p, rlf_vec3 ray, people_cloth *out_cloth);

#endif
