/* Table 5.1 of a source: on the screen, as CSV and as JSON. */
#ifndef RELIEF_APP_MEASURE_TABLE_H
#define RELIEF_APP_MEASURE_TABLE_H

#include "measure/points.h"

#define MEASURE_SCALES_MAX 8

typedef struct measure_report {
    const char *source;
    rlf_profile profile;
    const int32_t *scales;
    const measure_points *points; /* one per scale */
    int32_t count;
} measure_report;

void measure_print(const measure_report *r);
rlf_result measure_write_csv(const measure_report *r, const char *path);
rlf_result measure_write_json(const measure_report *r, const char *path);

#endif
