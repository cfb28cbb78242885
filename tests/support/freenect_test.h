/* What the tests of libfreenect share: the formula of depth. */
#ifndef RLF_TEST_FREENECT_TEST_H
#define RLF_TEST_FREENECT_TEST_H

#include <math.h>
#include <stdint.h>

/* Millimetres of a raw count after libfreenect's formula; 0 = missing. */
static inline int freenect_test_mm(int raw, double emitter_cm, double reference_cm, double pixel_mm)
{
    const double x = ((raw - 4.0 * 200.0) / 4.0 - 0.375) * pixel_mm;
    const double mm = 10.0 * (x * reference_cm / (emitter_cm - x) + reference_cm);
    return raw < 2047 && x < emitter_cm && mm >= 1.0 && mm <= 10000.0 ? (int)lround(mm) : 0;
}

#endif
