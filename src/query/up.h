/* Inside the search for up: what of a surface is looked at, the axes that its normals have,
 * and what speaks for one end of an axis being up. */
#ifndef RLF_QUERY_UP_H
#define RLF_QUERY_UP_H

#include "relief/surface.h"

enum { RLF_UP_SAMPLES = 4096, RLF_UP_AXES = 12 };

/* cos 15 and sin 15 degrees: nearer than that a normal is along a direction, or across it. */
#define RLF_UP_ALONG 0.96592583
#define RLF_UP_ACROSS 0.25881905
/* cos 10 degrees: directions that are nearer are one. */
#define RLF_UP_SAME 0.98480775

/* Every step-th pixel of every step-th row. */
typedef struct rlf_up_samples {
    const rlf_surface *surface;
    int32_t step, columns, rows;
    int32_t count;                   /* of them, those that have a normal: */
    rlf_vec3 normal[RLF_UP_SAMPLES]; /* unit, towards the camera */
    int32_t pixel[RLF_UP_SAMPLES];
} rlf_up_samples;

void rlf_up_samples_take(const rlf_surface *surface, rlf_up_samples *out);

/* up_axes.c: directions that many normals are along or across; of each only one end. */
int32_t rlf_up_axes(const rlf_up_samples *samples, rlf_vec3 axes[RLF_UP_AXES]);

/* Turns *axis to the eigenvector of `a`, which is destroyed, with the least value; returns how much
 * less that is than the next. */
double rlf_up_least(double a[6][6], rlf_vec3 *axis);

/* up_level.c: turns `up` so that it stands on floors and tables. */
rlf_vec3 rlf_up_level(const rlf_surface *surface, rlf_vec3 up);

typedef struct rlf_up_evidence {
    double up, down;       /* shares of the normals that are along the direction, and against it */
    double across, square; /* and across it, within 15 and within 5 degrees */
    double standing;   /* share of the pixels that are of small things on the largest plane there */
    double likelihood; /* logarithm, mean of all samples: of what their rays end on */
} rlf_up_evidence;

/* up_evidence.c */
rlf_up_evidence rlf_up_ask(const rlf_up_samples *samples, rlf_vec3 up);

#endif
