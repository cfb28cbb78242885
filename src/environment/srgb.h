/* From the codes of colours to light. */
#ifndef RLF_ENVIRONMENT_SRGB_H
#define RLF_ENVIRONMENT_SRGB_H

#include "kernel/kernel.h"

#include <stdint.h>

/* sRGB's curve as a polynomial, 0..1. */
RLF_KERNEL_PART float srgb_to_linear(uint8_t code)
{
    float c = (float)code * (1.0f / 255.0f);
    return c * (c * (c * 0.305306011f + 0.682171111f) + 0.012522878f);
}

#endif
