/* Where a depth camera's pixels are missing. */
#ifndef RELIEF_APP_INFO_MISSING_H
#define RELIEF_APP_INFO_MISSING_H

#include "relief/frame.h"

typedef enum missing_kind {
    MISSING_RIM = 0,    /* whole rows or columns at the picture's border */
    MISSING_BORDER = 1, /* holes that reach the border or the rim */
    MISSING_STEP = 2,   /* beside a depth step: shadows of what is near */
    MISSING_INSIDE = 3, /* holes in a surface: dark, shiny, clear, too bright */
    MISSING_NEAR = 4,   /* measured, but nearer than the range */
    MISSING_FAR = 5,    /* measured, but beyond the range */
    MISSING_KIND_COUNT = 6
} missing_kind;

typedef struct missing_counts {
    int64_t frames, pixels; /* of all frames */
    int64_t kinds[MISSING_KIND_COUNT];
} missing_counts;

/* Adds one frame; `depth` in metres, 0 = missing, in rows without padding. */
void missing_add(missing_counts *counts, const rlf_rig *rig, const float *depth);

/* Percent of all pixels; 0 without frames. */
double missing_percent(const missing_counts *counts, missing_kind kind);
double missing_percent_all(const missing_counts *counts);
/* For a table: "rim", "beside depth steps", ... */
const char *missing_name(missing_kind kind);

#endif
