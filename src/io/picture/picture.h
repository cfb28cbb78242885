/* Decoding pictures from memory. */
#ifndef RLF_IO_PICTURE_PICTURE_H
#define RLF_IO_PICTURE_PICTURE_H

#include "io/file.h"
#include "io/little.h"
#include "relief/base.h"
#include "relief/image.h"

#include <string.h>

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

/* ---- Bytes that are put together one after the other ---- */

/* Grows as needed and keeps its memory; zeroed = empty. Once memory is short nothing is added any
 * more and `is_short` stays set, so that a writer checks once, at its end. */
typedef struct io_byte_buffer {
    uint8_t *data;
    size_t size, capacity;
    bool is_short;
} io_byte_buffer;

/* Room for `size` more bytes, or NULL. They count once io_byte_buffer_grow says so. */
uint8_t *io_byte_buffer_reserve(io_byte_buffer *buffer, size_t size);
void io_byte_buffer_add(io_byte_buffer *buffer, const void *data, size_t size);
/* RLF_OK, or RLF_ERROR_MEMORY when something could not be added. */
rlf_result io_byte_buffer_check(const io_byte_buffer *buffer);
void io_byte_buffer_free(io_byte_buffer *buffer);

/* Of the bytes reserved last, `size` were written. */
static inline void io_byte_buffer_grow(io_byte_buffer *buffer, size_t size)
{
    buffer->size += size;
}

/* Little-endian numbers. */
static inline void io_put_u8(io_byte_buffer *b, uint8_t value)
{
    io_byte_buffer_add(b, &value, sizeof(value));
}
static inline void io_put_u16(io_byte_buffer *b, uint16_t value)
{
    io_little(&value, 1, sizeof(value));
    io_byte_buffer_add(b, &value, sizeof(value));
}
static inline void io_put_u32(io_byte_buffer *b, uint32_t value)
{
    io_little(&value, 1, sizeof(value));
    io_byte_buffer_add(b, &value, sizeof(value));
}
static inline void io_put_u64(io_byte_buffer *b, uint64_t value)
{
    io_little(&value, 1, sizeof(value));
    io_byte_buffer_add(b, &value, sizeof(value));
}

/* ---- Pictures to PNG and JPEG in memory ---- */

/* Pixels of a picture that is to become a PNG. */
typedef enum io_png_pixels {
    IO_PNG_GREY_U8 = 0,
    IO_PNG_GREY_U16 = 1,
    IO_PNG_RGBA = 2,
    IO_PNG_RGB = 3,          /* given as RGBA; alpha is left out */
    IO_PNG_PREMULTIPLIED = 4 /* given as RGBA whose colours alpha was multiplied into */
} io_png_pixels;

typedef struct io_png_def {
    const char *name; /* for error lines */
    const void *data;
    int32_t width, height;
    ptrdiff_t stride; /* bytes */
    io_png_pixels pixels;
    int32_t level; /* of zlib, 1..9 */
} io_png_def;

/* Divides the colours of RGBA or BGRA pixels by the alpha that was multiplied into them. */
void io_rgba_straighten(uint8_t *rgba, size_t pixels);
/* Appends the file. On failure the buffer is as it was. */
rlf_result io_png_encode(const io_png_def *def, io_byte_buffer *out);

/* Keeps what libturbojpeg needs from picture to picture. */
typedef struct io_jpeg_encoder io_jpeg_encoder;

rlf_result io_jpeg_encoder_create(io_jpeg_encoder **out);
void io_jpeg_encoder_destroy(io_jpeg_encoder **encoder);
/* Appends the file: quality 1..100, colour at half the resolution (4:2:0), alpha left out. */
rlf_result io_jpeg_encode(io_jpeg_encoder *encoder, const rlf_image_rgba8 *image, int32_t quality,
                          io_byte_buffer *out);

#endif
