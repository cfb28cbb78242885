/* Decoding pictures from memory. */
#ifndef RLF_IO_PICTURE_PICTURE_H
#define RLF_IO_PICTURE_PICTURE_H

#include "relief/image.h"
#include "io/file.h"

/* No picture that Relief accepts needs a larger file: 16384 x 16384 RGBA of 16 bits. */
#define IO_PICTURE_FILE_MAX ((size_t)2 << 30)

/* What to decode into. */
typedef struct io_picture {
    int32_t width, height; /* given: the only size allowed; 0: any, and set to what it is */
    void *data; /* given: rows without padding; NULL: allocated with rlf_alloc. Pixels are RGBA or
                   uint16_t, as the function says */
    bool is_opaque;     /* in: replace alpha by 255 */
    int32_t size_max;   /* in: largest width and height; 0 = RLF_IMAGE_SIZE_MAX */
    int64_t pixels_max; /* in: largest width times height; 0 = any */
} io_picture;

bool io_png_is(const io_bytes *file);
/* Whether it is a PNG of 16-bit grey, as depth is. */
bool io_png_is_u16(const io_bytes *file);

/* 16-bit grey PNG to uint16_t. On failure nothing stays allocated. */
rlf_result io_png_decode_u16(const io_bytes *file, io_picture *picture);
/* 16-bit colour PNG to three uint16_t a pixel. */
rlf_result io_png_decode_rgb_u16(const io_bytes *file, io_picture *picture);
/* Any PNG to RGBA. */
rlf_result io_png_decode_rgba(const io_bytes *file, io_picture *picture);
/* JPEG to RGBA. */
rlf_result io_jpeg_decode_rgba(const io_bytes *file, io_picture *picture);
/* PNG or JPEG to RGBA, told apart by their first bytes. */
rlf_result io_picture_decode(const io_bytes *file, io_picture *picture);

/* What a PNG or JPEG says of its size; false when it cannot be told. */
bool io_picture_size(const io_bytes *file, int32_t *out_width, int32_t *out_height);
bool io_jpeg_size(const io_bytes *file, int32_t *out_width, int32_t *out_height);

/* The error for a picture of another size than its camera's. */
rlf_result io_picture_fail_size(const char *name, int64_t width, int64_t height,
                                int32_t wanted_width, int32_t wanted_height);

/* Checks the size found in a file against the wanted one and the limits, and whether `file_size`
 * bytes can hold so many pixels at `pixels_per_byte`; then allocates when data is NULL. */
rlf_result io_picture_prepare(const io_bytes *file, io_picture *picture, int64_t width,
                              int64_t height, int64_t pixels_per_byte, size_t pixel_size);

#endif
