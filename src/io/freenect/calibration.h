/* Kinect v1: from the sensor's counts to depth, and how its two cameras stand. */
#ifndef RLF_IO_FREENECT_CALIBRATION_H
#define RLF_IO_FREENECT_CALIBRATION_H

#include "io/freenect/api.h"
#include "relief/frame.h"

#define FREENECT_UNITS_PER_METRE 1000.0

/* Whether the device told its reference plane. */
bool freenect_has_reference(const freenect_registration *registration);

/* Depth in millimetres of each raw count, rounded; 0 = missing. `registration` NULL = the values of
 * a typical device. */
void freenect_depth_table(const freenect_registration *registration,
                          uint16_t out[FREENECT_RAW_COUNT]);

/* The depth camera, the colour camera and the transform between them. Factory tables, where they
 * are, are fitted by a turn round the optical axis, a shift, and the colour camera's lens:
 * *out_error is the largest distance in colour pixels from what the tables say; -1 = no tables. */
void freenect_make_rig(const freenect_registration *registration, rlf_rig *out, double *out_error);

#endif
