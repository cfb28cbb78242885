/* libfreenect2 speaks C++ only. This is what Relief needs of it as C functions of a small shared
 * library of its own, librelief_freenect2.so, which is opened at run time. */
#ifndef RLF_IO_FREENECT2_FREENECT2_SHIM_H
#define RLF_IO_FREENECT2_FREENECT2_SHIM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RELIEF_FREENECT2_VERSION 2

typedef struct relief_freenect2 relief_freenect2;

/* Numbers of the factory, in the order of libfreenect2's IrCameraParams and ColorCameraParams. */
typedef struct relief_freenect2_calibration {
    float ir[9];
    float color[26];
} relief_freenect2_calibration;

/* A depth picture and the colour picture nearest in time; mirrored. They stay valid until the next
 * call of wait that returns 1. */
typedef struct relief_freenect2_frame {
    const float *depth;                  /* 512 x 424, millimetres; <= 0, NaN, infinite = missing */
    uint32_t depth_sequence, depth_time; /* time in units of 0.125 ms, wraps */
    const uint8_t *color;                /* 1920 x 1080, 4 bytes a pixel; NULL = none */
    uint32_t color_time;
    int32_t color_is_rgbx; /* else BGRX */
} relief_freenect2_frame;

/* F(result, name without relief_freenect2_, parameters)
 * count: plugged-in cameras. serial: of one of them, 0 when there is no such. open: NULL on
 * failure, with the cause. wait: 1 = a frame, 0 = none in time, -1 = the camera failed.
 * registration: of the pictures given last, which have colour, what libfreenect2's Registration
 * makes, 512 x 424 each: depth without the lens's distortion, and the colour of its pixels. */
#define RELIEF_FREENECT2_FUNCTIONS(F)                                                              \
    F(int, version, (void))                                                                        \
    F(int, count, (void))                                                                          \
    F(int, serial, (int index, char *out, size_t size))                                            \
    F(relief_freenect2 *, open, (const char *serial, char *out_cause, size_t size))                \
    F(void, get_calibration, (relief_freenect2 *, relief_freenect2_calibration * out))             \
    F(int, wait, (relief_freenect2 *, int timeout_ms, relief_freenect2_frame *out))                \
    F(void, registration, (relief_freenect2 *, float *out_depth, uint32_t *out_color))             \
    F(void, close, (relief_freenect2 *))

#define RELIEF_FREENECT2_DECLARE(result, name, parameters)                                         \
    result relief_freenect2_##name parameters;
RELIEF_FREENECT2_FUNCTIONS(RELIEF_FREENECT2_DECLARE)
#undef RELIEF_FREENECT2_DECLARE

#ifdef __cplusplus
}
#endif
#endif
