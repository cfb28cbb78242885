/* Where depth jumps from one surface to another. */
#ifndef RLF_ENVIRONMENT_DEPTH_EDGE_H
#define RLF_ENVIRONMENT_DEPTH_EDGE_H

#include "kernel/kernel.h"

#include <stdint.h>

/* True when depth jumps from `a` to its neighbour `b`. */
RLF_KERNEL_PART bool depth_steps(float a, float b)
{
    float nearer = a < b ? a : b;
    float step = a < b ? b - a : a - b;
    return step > 0.02f + 0.012f * nearer;
}

/* ---- From the codes of colours to light. */

/* sRGB's curve as a polynomial, 0..1. */
RLF_KERNEL_PART float srgb_to_linear(uint8_t code)
{
    float c = (float)code * (1.0f / 255.0f);
    return c * (c * (c * 0.305306011f + 0.682171111f) + 0.012522878f);
}

#endif
