/* `relief calibrate --check`: does a calibration still hold, and how does the camera stand. */
#ifndef RELIEF_APP_CALIBRATE_CHECK_H
#define RELIEF_APP_CALIBRATE_CHECK_H

#include "relief/reconstruct.h"

#define CALIBRATE_STAND_BINS 400 /* 2 cm each: 8 m below the camera */

/* What frames say about up and about level faces; all 0 to begin with. */
typedef struct calibrate_stand {
    int32_t frames, sure;
    rlf_vec3 up; /* sum over the frames that are sure, or of guesses while none is */
    int64_t level, count[CALIBRATE_STAND_BINS];
    double below_m[CALIBRATE_STAND_BINS]; /* sums */
} calibrate_stand;

void calibrate_stand_add(calibrate_stand *s, const rlf_surface *surface);
/* How far the floor's plane is below the camera, metres; false = no floor is seen. */
bool calibrate_stand_floor(const calibrate_stand *s, double *out_below_m);

/* Measures a source and prints it. */
rlf_result calibrate_check(const char *name, bool *out_is_stale);
/* The same of a list of cameras (docs/several-cameras.md): whether the surfaces that they share lie
 * on each other. Writes the list with poses by the room to out_path; NULL = only prints. */
rlf_result calibrate_check_cameras(const char *list, const char *out_path, bool *out_is_off);

#endif
