/* The cameras of pushed frames as a page writes them: numbers at an address. */
#include "page.h"

#include <string.h>

/* A camera's numbers: width, height, fx, fy, cx, cy, model, k1 .. k6. */
enum { CAMERA_NUMBERS = 15 };

/* relief.js writes the same order. */
enum {
    DEPTH = 0,
    COLOR = DEPTH + CAMERA_NUMBERS,
    HAS_COLOR = COLOR + CAMERA_NUMBERS,
    COLOR_FROM_DEPTH = HAS_COLOR + 1, /* position, quaternion x y z w */
    RANGE = COLOR_FROM_DEPTH + 7,     /* nearest, farthest, metres; 0: the default */
    NOISE = RANGE + 2,                /* c0, c1, c2; all 0: the default */
    OFFSET = NOISE + 3,
    RIG_NUMBERS = OFFSET + 1
};

static double numbers[RIG_NUMBERS];

/* Where the page writes a rig, all zero. */
double *EXPORT(relief_rig_in)(void)
{
    memset(numbers, 0, sizeof(numbers));
    return numbers;
}

static rlf_camera read_camera(const double *n)
{
    rlf_camera c = {.width = (int32_t)n[0],
                    .height = (int32_t)n[1],
                    .fx = n[2],
                    .fy = n[3],
                    .cx = n[4],
                    .cy = n[5],
                    .distortion_model = (rlf_distortion_model)n[6]};
    memcpy(c.distortion, n + 7, sizeof(c.distortion));
    return c;
}

rlf_rig page_rig_read(void)
{
    rlf_rig rig = rlf_rig_default();
    const double *p = numbers + COLOR_FROM_DEPTH;
    rig.depth = read_camera(numbers + DEPTH);
    rig.has_color = numbers[HAS_COLOR] != 0.0;
    if (rig.has_color) {
        rig.color = read_camera(numbers + COLOR);
        rig.T_color_depth.p = rlf_vec3_make(p[0], p[1], p[2]);
        rig.T_color_depth.q = rlf_quat_normalize((rlf_quat){p[3], p[4], p[5], p[6]});
    }
    if (numbers[RANGE + 1] > 0.0) {
        rig.depth_min_m = numbers[RANGE];
        rig.depth_max_m = numbers[RANGE + 1];
    }
    if (numbers[NOISE] > 0.0 || numbers[NOISE + 1] > 0.0 || numbers[NOISE + 2] > 0.0) {
        rig.noise = (rlf_depth_noise){numbers[NOISE], numbers[NOISE + 1], numbers[NOISE + 2]};
    }
    rig.depth_offset_m = numbers[OFFSET];
    return rig;
}
