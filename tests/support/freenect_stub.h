/* What the stand-in for libfreenect plays, and how a test steers it. */
#ifndef RLF_TEST_FREENECT_STUB_H
#define RLF_TEST_FREENECT_STUB_H

#include "io/freenect/freenect.h"

#define STUB_SERIAL "B00364213908042B"

/* Its colour camera, turned by asin(0.01) and STUB_COLOR_CM to the right. */
#define STUB_PIXEL_MM 0.1052f
#define STUB_COLOR_CM 2.4
#define STUB_FX 524.0
#define STUB_FY 526.0
#define STUB_CX 322.25
#define STUB_CY 246.5
#define STUB_SIN 0.01
#define STUB_COS 0.99995
#define STUB_K1 0.05

typedef struct freenect_stub_event {
    bool is_depth;
    int picture;
    uint32_t ticks;
} freenect_stub_event;

typedef struct freenect_stub_control {
    const freenect_stub_event *events;
    int count, next;
    bool is_absent, does_not_start, is_unplugged, has_video;
    int depth_format, subdevices;
} freenect_stub_control;

/* Raw count of picture n: all 11-bit values occur. */
static inline uint16_t stub_raw(int n, int x, int y)
{
    return (uint16_t)((x + 3 * y + 17 * n) % FREENECT_RAW_COUNT);
}

#endif
