/* Relief: views of image planes. A view owns nothing.
 *
 * `stride` is in bytes between rows and may be larger than a row. Row 0 is the top.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_IMAGE_H
#define RELIEF_IMAGE_H

#include "relief/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Largest width or height that Relief accepts anywhere, in pixels. */
#define RLF_IMAGE_SIZE_MAX 16384

/* 8-bit RGBA, interleaved, 4 bytes per pixel, alpha 255 = opaque. sRGB as cameras deliver it. */
typedef struct rlf_image_rgba8 {
    uint8_t *data;
    int32_t width, height;
    ptrdiff_t stride;
} rlf_image_rgba8;

/* One byte per pixel: masks (0 or 1), mattes (0..255), reason codes. */
typedef struct rlf_plane_u8 {
    uint8_t *data;
    int32_t width, height;
    ptrdiff_t stride;
} rlf_plane_u8;

/* One float per pixel, e.g. depth in metres with 0 = missing. */
typedef struct rlf_plane_f32 {
    float *data;
    int32_t width, height;
    ptrdiff_t stride;
} rlf_plane_f32;

static inline uint8_t *rlf_rgba8_row(const rlf_image_rgba8 *image, int32_t y)
{
    return image->data + (ptrdiff_t)y * image->stride;
}
static inline uint8_t *rlf_u8_row(const rlf_plane_u8 *plane, int32_t y)
{
    return plane->data + (ptrdiff_t)y * plane->stride;
}
static inline float *rlf_f32_row(const rlf_plane_f32 *plane, int32_t y)
{
    return (float *)(void *)((char *)plane->data + (ptrdiff_t)y * plane->stride);
}

#ifdef __cplusplus
}
#endif
#endif
