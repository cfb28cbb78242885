/* A depth camera without distortion that looks along the middle of its picture. */
#ifndef RLF_TEST_PINHOLE_H
#define RLF_TEST_PINHOLE_H

#include "relief/camera.h"

static inline rlf_camera pinhole(int32_t width, int32_t height, double focal)
{
    return (rlf_camera){.width = width,
                        .height = height,
                        .fx = focal,
                        .fy = focal,
                        .cx = 0.5 * (width - 1),
                        .cy = 0.5 * (height - 1)};
}

#endif
