/* Pictures to PNG and JPEG in memory. */
#ifndef RLF_IO_CODEC_PICTURE_ENCODE_H
#define RLF_IO_CODEC_PICTURE_ENCODE_H

#include "io/codec/byte_buffer.h"
#include "relief/image.h"

/* Pixels of a picture that is to become a PNG. */
typedef enum io_png_pixels {
    IO_PNG_GREY_U8 = 0,
    IO_PNG_GREY_U16 = 1,
    IO_PNG_RGBA = 2,
    IO_PNG_RGB = 3 /* given as RGBA; alpha is left out */
} io_png_pixels;

typedef struct io_png_def {
    const char *name; /* for error lines */
    const void *data;
    int32_t width, height;
    ptrdiff_t stride; /* bytes */
    io_png_pixels pixels;
    int32_t level; /* of zlib, 1..9 */
} io_png_def;

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
