/* Relief: views of image planes. A view owns nothing.
 *
 * `stride` is in bytes between rows and may be larger than a row, so a view may be a part of a
 * picture. Row 0 is the top, x goes right. Who gave the memory says how long it lives; a function
 * that gets a view borrows it for the call. Copying the struct copies the view, not the pixels.
 * SPDX-License-Identifier: MIT */
#ifndef RELIEF_IMAGE_H
#define RELIEF_IMAGE_H

#include "relief/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Largest width or height that Relief accepts anywhere, in pixels. */
#define RLF_IMAGE_SIZE_MAX 16384

/* 8-bit RGBA, interleaved: the bytes of a pixel are R, G, B, A whatever the machine's byte
 * order. Alpha 255 = opaque; it does not multiply the colour. sRGB as cameras deliver it, so
 * sums of light need linear values first.
 *
 * A picture that is not there has data NULL. Rows need no alignment. Written by renderers and
 * readers of files; a frame's is read only. */
typedef struct rlf_image_rgba8 {
    uint8_t *data;         /* first byte of row 0; the memory is somebody else's */
    int32_t width, height; /* pixels, 1 to RLF_IMAGE_SIZE_MAX */
    ptrdiff_t stride;      /* bytes from row to row, at least 4 * width */
} rlf_image_rgba8;

/* One byte per pixel: masks (0 or 1), mattes (0 nothing .. 255 whole), reason codes. The field that
 * holds it says which. */
typedef struct rlf_plane_u8 {
    uint8_t *data;         /* first byte of row 0 */
    int32_t width, height; /* pixels */
    ptrdiff_t stride;      /* bytes from row to row, at least width */
} rlf_plane_u8;

/* One float per pixel, e.g. depth in metres with 0 = missing. The stride is a multiple of 4, and
 * the rows are aligned to 4 bytes. */
typedef struct rlf_plane_f32 {
    float *data;           /* first value of row 0 */
    int32_t width, height; /* pixels */
    ptrdiff_t stride;      /* bytes, not floats, from row to row, at least 4 * width */
} rlf_plane_f32;

/* First byte of row y, 0 <= y < height, which is not checked. Pixel x is at 4 x. The offset is
 * worked out in ptrdiff_t, since a picture of the largest size has 1 GiB. */
static inline uint8_t *rlf_rgba8_row(const rlf_image_rgba8 *image, int32_t y)
{
    return RLF_ASSERT(image != NULL) ? image->data + (ptrdiff_t)y * image->stride : NULL;
}
/* First byte of row y, 0 <= y < height, which is not checked. Pixel x is at x. */
static inline uint8_t *rlf_u8_row(const rlf_plane_u8 *plane, int32_t y)
{
    return RLF_ASSERT(plane != NULL) ? plane->data + (ptrdiff_t)y * plane->stride : NULL;
}
/* First float of row y, 0 <= y < height, which is not checked. Pixel x is at x, in floats.
 *
 * A view does not say whether its rows may be written: what is const in a frame or a surface
 * stays so for readers of its rows. */
static inline float *rlf_f32_row(const rlf_plane_f32 *plane, int32_t y)
{
    return RLF_ASSERT(plane != NULL)
               ? (float *)(void *)((char *)plane->data + (ptrdiff_t)y * plane->stride)
               : NULL;
}

#ifdef __cplusplus
}
#endif
#endif
