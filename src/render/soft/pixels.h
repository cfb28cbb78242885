/* Pixels as numbers: the lowest byte is red, whatever the machine's order. */
#ifndef RLF_RENDER_SOFT_PIXELS_H
#define RLF_RENDER_SOFT_PIXELS_H

#include "kernel/kernel.h"

#include <string.h>

RLF_KERNEL_PART void soft_load_pixels(const uint8_t *bytes, int32_t count, uint32_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, bytes, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < count; i++) {
        const uint8_t *p = bytes + 4 * (ptrdiff_t)i;
        out[i] = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    }
#endif
}

RLF_KERNEL_PART void soft_store_pixels(const uint32_t *pixels, int32_t count, uint8_t *out)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    memcpy(out, pixels, 4 * (size_t)count);
#else
    for (int32_t i = 0; i < 4 * count; i++) {
        out[i] = (uint8_t)(pixels[i / 4] >> 8 * (i % 4));
    }
#endif
}

#endif
