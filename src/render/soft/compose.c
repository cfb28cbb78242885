/* Puts a row of bodies over the real picture. */
#include "kernel/kernel.h"
#include "render/soft/soft.h"

#define CHUNK 64 /* pixels between steps */

RLF_KERNEL_PART float over(uint32_t real, float rest, float color)
{
    float value = (float)(int32_t)(real & 255u) * rest + color + 0.5f;
    return value < 255.0f ? value : 255.0f;
}

RLF_KERNEL_PART void blend(const float *restrict red, const float *restrict green,
                           const float *restrict blue, const float *restrict shown, int32_t count,
                           uint32_t *restrict pixels)
{
    for (int32_t i = 0; i < count; i++) {
        uint32_t real = pixels[i];
        float rest = 1.0f - shown[i];
        uint32_t r = (uint32_t)(int32_t)over(real, rest, red[i]);
        uint32_t g = (uint32_t)(int32_t)over(real >> 8, rest, green[i]);
        uint32_t b = (uint32_t)(int32_t)over(real >> 16, rest, blue[i]);
        pixels[i] = r | g << 8 | b << 16 | (real & 0xff000000u);
    }
}

RLF_KERNEL_PART void to_matte(const float *restrict shown, int32_t count, uint8_t *restrict out)
{
    for (int32_t i = 0; i < count; i++) {
        float alpha = 255.0f * shown[i] + 0.5f;
        out[i] = (uint8_t)(int32_t)(alpha < 255.0f ? alpha : 255.0f);
    }
}

/* Picture = real picture * (1 - alpha) + colour, colour being premultiplied. */
RLF_KERNEL void soft_compose_row(float *const sum[4], int32_t count, uint8_t *restrict pixels,
                                 uint8_t *restrict matte)
{
    uint32_t block[CHUNK];
    for (int32_t first = 0; first < count; first += CHUNK) {
        int32_t size = count - first < CHUNK ? count - first : CHUNK;
        const float *shown = sum[3] + first;
        int32_t empty = 0;
        while (empty < size && !(shown[empty] > 0.0f)) {
            empty++;
        }
        if (empty < size) {
            soft_load_pixels(pixels + 4 * (ptrdiff_t)first, size, block);
            blend(sum[0] + first, sum[1] + first, sum[2] + first, shown, size, block);
            soft_store_pixels(block, size, pixels + 4 * (ptrdiff_t)first);
            to_matte(shown, size, matte + first);
        }
    }
}
