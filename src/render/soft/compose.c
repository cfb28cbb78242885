/* Puts a row of bodies over the real picture. */
#include "render/soft/passes.h"

#include "kernel/kernel.h"
#include "render/soft/soft.h"

RLF_KERNEL_PART float over(uint32_t real, float rest, float color)
{
    float value = (float)(int32_t)(real & 255u) * rest + color + 0.5f;
    return value < 255.0f ? value : 255.0f;
}

RLF_KERNEL_PART void blend(const float *restrict red, const float *restrict green,
                           const float *restrict blue, const float *restrict shown,
                           uint32_t *restrict pixels)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        uint32_t real = pixels[i];
        float rest = 1.0f - shown[i];
        uint32_t r = (uint32_t)(int32_t)over(real, rest, red[i]);
        uint32_t g = (uint32_t)(int32_t)over(real >> 8, rest, green[i]);
        uint32_t b = (uint32_t)(int32_t)over(real >> 16, rest, blue[i]);
        pixels[i] = r | g << 8 | b << 16 | (real & 0xff000000u);
    }
}

RLF_KERNEL_PART void to_matte(const float *restrict shown, uint8_t *restrict out)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        float alpha = 255.0f * shown[i] + 0.5f;
        out[i] = (uint8_t)(int32_t)(alpha < 255.0f ? alpha : 255.0f);
    }
}

RLF_KERNEL_PART bool is_empty(const float *restrict shown)
{
    int32_t any = 0;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        any |= shown[i] > 0.0f ? 1 : 0;
    }
    return any == 0;
}

/* True when nothing is seen of what is real. */
RLF_KERNEL_PART bool is_full(const float *restrict shown)
{
    int32_t all = 1;
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        all &= shown[i] == 1.0f ? 1 : 0;
    }
    return all != 0;
}

RLF_KERNEL_PART uint32_t to_byte(float color)
{
    float value = color + 0.5f;
    return (uint32_t)(int32_t)(value < 255.0f ? value : 255.0f);
}

/* The same as blend where shown is 1. */
RLF_KERNEL_PART void replace(const float *restrict red, const float *restrict green,
                             const float *restrict blue, uint32_t *restrict pixels)
{
    RLF_KERNEL_WHOLE
    for (int32_t i = 0; i < SOFT_LANES; i++) {
        uint32_t color = to_byte(red[i]) | to_byte(green[i]) << 8 | to_byte(blue[i]) << 16;
        pixels[i] = color | (pixels[i] & 0xff000000u);
    }
}

/* Picture = real picture * (1 - alpha) + colour, colour being premultiplied. The last lanes' sums
 * may be beyond `count`. */
RLF_KERNEL void soft_compose_row(float *const sum[4], int32_t count, uint8_t *restrict pixels,
                                 uint8_t *restrict matte)
{
    for (int32_t first = 0; first < count; first += SOFT_LANES) {
        const int32_t size = count - first < SOFT_LANES ? count - first : SOFT_LANES;
        const float *shown = sum[3] + first;
        uint32_t block[SOFT_LANES] = {0};
        uint8_t alpha[SOFT_LANES];
        if (is_empty(shown)) {
            continue;
        }
        uint8_t *const at = pixels + 4 * (ptrdiff_t)first;
        if (size == SOFT_LANES) { /* its own case, for a size that is known */
            soft_load_pixels(at, SOFT_LANES, block);
        } else {
            soft_load_pixels(at, size, block);
        }
        if (is_full(shown)) {
            replace(sum[0] + first, sum[1] + first, sum[2] + first, block);
            memset(alpha, 255, SOFT_LANES);
        } else {
            blend(sum[0] + first, sum[1] + first, sum[2] + first, shown, block);
            to_matte(shown, alpha);
        }
        if (size == SOFT_LANES) {
            soft_store_pixels(block, SOFT_LANES, at);
            memcpy(matte + first, alpha, SOFT_LANES);
        } else {
            soft_store_pixels(block, size, at);
            memcpy(matte + first, alpha, (size_t)size);
        }
    }
}
