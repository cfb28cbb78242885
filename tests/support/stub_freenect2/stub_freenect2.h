/* Control of the stub shim of libfreenect2. */
#ifndef RLF_TEST_STUB_FREENECT2_H
#define RLF_TEST_STUB_FREENECT2_H

#include "stub_camera.h"

typedef struct stub_freenect2 {
    stub_fault fault;
    bool is_rgbx;
    uint32_t first_time;  /* of the device's clock, in its units of 0.125 ms */
    bool has_bad_numbers; /* calibration of a broken camera */
} stub_freenect2;

stub_freenect2 *stub_freenect2_get(void);

/* Units of the device's clock between pictures: 30 a second. */
#define STUB_K2_TICKS 267
#define STUB_K2_COLOR_LATE_TICKS 20

/* Colour pixel of the first depth pixel. */
#define STUB_K2_ALIGNED_X 150
#define STUB_K2_ALIGNED_Y 100

#endif
