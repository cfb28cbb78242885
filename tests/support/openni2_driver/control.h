/* What the test driver for OpenNI2 shows, and how a test steers it.
 *
 * A test opens the driver's shared object a second time and asks it for openni2_test_control. */
#ifndef RLF_TEST_OPENNI2_CONTROL_H
#define RLF_TEST_OPENNI2_CONTROL_H

#include <stdbool.h>
#include <stdint.h>

#define DRIVER_URI "test://1/2"
#define DRIVER_SERIAL "A00363A01234"
#define DRIVER_FOV_X 1.0145f
#define DRIVER_FOV_Y 0.7898f
#define DRIVER_MAX_DEPTH 10000

typedef struct openni2_test_control {
    /* Tells a stream's reader of picture n; the device's count is `index`. Mirrored when the
     * stream's property says so. False = the stream is not started. */
    bool (*send)(bool is_depth, int n, uint64_t time_us, int index);
    void (*unplug)(void);
    void (*plug)(void);
    bool mirror_is_stuck; /* refuses to turn mirroring off */
    bool cannot_register;
    bool has_no_fov;
    bool is_registered; /* what was asked for last */
    int open_count;     /* devices that are open now */
} openni2_test_control;

/* Depth of picture n in millimetres, not mirrored: a slanted wall with holes. */
static inline uint16_t driver_depth(int n, int x, int y)
{
    return (x + n) % 97 == 0 ? 0 : (uint16_t)(800 + 2 * x + y + 7 * (n % 50));
}

static inline uint8_t driver_color(int n, int x, int y, int channel)
{
    return (uint8_t)(x * (channel + 1) + y * 3 + n * 11);
}

#endif
