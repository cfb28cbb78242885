/* PNG to memory through libpng. Its errors come back by longjmp, so everything that must survive
 * one lives in a struct outside the function that calls setjmp. */
#include "io/picture/picture.h"
#include "io/little.h"
#include "relief/io.h"
#include "io/file.h"

#include <png.h>
#include <stdio.h>

typedef struct writer {
    const io_png_def *def;
    io_byte_buffer *out;
    png_structp png;
    png_infop info;
    char problem[128];
} writer;

static void on_error(png_structp png, png_const_charp message)
{
    writer *w = png_get_error_ptr(png);
    snprintf(w->problem, sizeof(w->problem), "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void write_bytes(png_structp png, png_bytep data, size_t size)
{
    writer *w = png_get_io_ptr(png);
    io_byte_buffer_add(w->out, data, size);
    if (w->out->is_short) {
        png_error(png, "out of memory");
    }
}

static void flush_bytes(png_structp png)
{
    (void)png;
}

void io_rgba_straighten(uint8_t *rgba, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        uint8_t *pixel = rgba + 4 * i;
        const int32_t alpha = pixel[3];
        for (int c = 0; c < 3 && alpha > 0 && alpha < 255; c++) {
            const int32_t color = (255 * pixel[c] + alpha / 2) / alpha;
            pixel[c] = (uint8_t)(color < 255 ? color : 255);
        }
    }
}

/* libpng's own copy of a row. */
static void straighten(png_structp png, png_row_infop row, png_bytep data)
{
    (void)png;
    io_rgba_straighten(data, row->width);
}

static void encode(writer *w)
{
    static const int types[5] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_RGBA,
                                 PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGBA};
    const io_png_def *d = w->def;
    png_set_write_fn(w->png, w, write_bytes, flush_bytes);
    png_set_IHDR(w->png, w->info, (png_uint_32)d->width, (png_uint_32)d->height,
                 d->pixels == IO_PNG_GREY_U16 ? 16 : 8, types[d->pixels], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(w->png, d->level);
    png_write_info(w->png, w->info);
    if (d->pixels == IO_PNG_GREY_U16 && !IO_IS_BIG_ENDIAN) {
        png_set_swap(w->png); /* PNG is big-endian */
    }
    if (d->pixels == IO_PNG_RGB) {
        png_set_filler(w->png, 0, PNG_FILLER_AFTER);
    }
    if (d->pixels == IO_PNG_PREMULTIPLIED) {
        png_set_write_user_transform_fn(w->png, straighten);
    }
    for (int32_t y = 0; y < d->height; y++) {
        png_write_row(w->png, (const uint8_t *)d->data + (ptrdiff_t)y * d->stride);
    }
    png_write_end(w->png, w->info);
}

/* Alone in its function, so that no local variable is live across the jump. */
static bool encode_or_jump(writer *w)
{
    if (setjmp(png_jmpbuf(w->png)) != 0) {
        return false;
    }
    encode(w);
    return true;
}

rlf_result io_png_encode(const io_png_def *def, io_byte_buffer *out)
{
    writer w = {.def = def, .out = out};
    const size_t size = out->size;
    rlf_result result = RLF_OK;
    w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w, on_error, on_warning);
    w.info = w.png != NULL ? png_create_info_struct(w.png) : NULL;
    if (w.info == NULL) {
        result = rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory while writing it", def->name);
    } else if (!encode_or_jump(&w)) {
        result = rlf_fail(out->is_short ? RLF_ERROR_MEMORY : RLF_ERROR_IO,
                          "%s: libpng refuses to write it: %s", def->name, w.problem);
    }
    png_destroy_write_struct(&w.png, &w.info);
    out->size = result == RLF_OK ? out->size : size;
    return result;
}

/* ---- files ------------------------------------------------------------------------------- */

/* Fast and nearly as small as the default level 6 on camera pictures. */
#define COMPRESSION_LEVEL 3

static bool is_size_usable(int32_t width, int32_t height)
{
    return width > 0 && height > 0 && width <= RLF_IMAGE_SIZE_MAX && height <= RLF_IMAGE_SIZE_MAX;
}

static rlf_result write_picture(const io_png_def *def)
{
    io_byte_buffer buffer = {0};
    rlf_result result = io_png_encode(def, &buffer);
    result = result == RLF_OK ? rlf_file_write(def->name, buffer.data, buffer.size) : result;
    io_byte_buffer_free(&buffer);
    return result;
}

static rlf_result write_rgba(const char *path, const rlf_image_rgba8 *image, io_png_pixels pixels)
{
    if (!RLF_ASSERT(path != NULL && image != NULL && image->data != NULL) ||
        !RLF_ASSERT(is_size_usable(image->width, image->height))) {
        return RLF_ERROR_INVALID;
    }
    const io_png_def def = {path,          image->data, image->width,     image->height,
                            image->stride, pixels,      COMPRESSION_LEVEL};
    return write_picture(&def);
}

rlf_result rlf_png_write_rgba(const char *path, const rlf_image_rgba8 *image)
{
    return write_rgba(path, image, IO_PNG_RGBA);
}

rlf_result rlf_png_write_premultiplied(const char *path, const rlf_image_rgba8 *image)
{
    return write_rgba(path, image, IO_PNG_PREMULTIPLIED);
}

rlf_result rlf_png_write_u8(const char *path, const rlf_plane_u8 *plane)
{
    if (!RLF_ASSERT(path != NULL && plane != NULL && plane->data != NULL) ||
        !RLF_ASSERT(is_size_usable(plane->width, plane->height))) {
        return RLF_ERROR_INVALID;
    }
    const io_png_def def = {path,          plane->data,    plane->width,     plane->height,
                            plane->stride, IO_PNG_GREY_U8, COMPRESSION_LEVEL};
    return write_picture(&def);
}

rlf_result rlf_png_write_u16(const char *path, const uint16_t *data, int32_t width, int32_t height)
{
    if (!RLF_ASSERT(path != NULL && data != NULL) || !RLF_ASSERT(is_size_usable(width, height))) {
        return RLF_ERROR_INVALID;
    }
    const io_png_def def = {
        path, data, width, height, (ptrdiff_t)width * 2, IO_PNG_GREY_U16, COMPRESSION_LEVEL};
    return write_picture(&def);
}
