/* Raw colour pictures of cameras to RGBA. */
#ifndef RLF_IO_DRIVER_PIXELS_H
#define RLF_IO_DRIVER_PIXELS_H

#include "relief/image.h"

typedef enum io_pixel_format {
    IO_PIXEL_NONE = 0, /* one that Relief does not read */
    IO_PIXEL_RGB8,
    IO_PIXEL_BGR8,
    IO_PIXEL_RGBX8,
    IO_PIXEL_BGRX8,
    IO_PIXEL_YUYV /* limited range, BT.601 */
} io_pixel_format;

typedef struct io_raw_picture {
    const uint8_t *data;
    size_t size;      /* bytes */
    ptrdiff_t stride; /* bytes */
    io_pixel_format format;
} io_raw_picture;

/* Writes the whole of *out, opaque; `is_mirrored`: left and right change sides. False when the raw
 * picture is smaller than that. */
bool io_raw_picture_to_rgba(const io_raw_picture *raw, bool is_mirrored,
                            const rlf_image_rgba8 *out);

#endif
