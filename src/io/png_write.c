/* PNG files through libpng. */
#include "relief/io.h"
#include "io/file.h"

#include <png.h>

/* Fast and nearly as small as the default level 6 on camera pictures. */
#define COMPRESSION_LEVEL 3

typedef struct writer {
    io_out_file file;
    png_structp png;
    png_infop info;
    const uint8_t *data;
    int32_t width, height;
    ptrdiff_t stride;
    int bit_depth, color_type;
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
    if (io_out_write(&w->file, data, size) != RLF_OK) {
        png_error(png, "write error");
    }
}

static void flush_bytes(png_structp png)
{
    (void)png; /* io_out_close flushes */
}

/* Alone in its function, so that no local variable is live across the jump. */
static bool encode_or_jump(writer *w)
{
    if (setjmp(png_jmpbuf(w->png)) != 0) {
        return false;
    }
    png_set_write_fn(w->png, w, write_bytes, flush_bytes);
    png_set_IHDR(w->png, w->info, (png_uint_32)w->width, (png_uint_32)w->height, w->bit_depth,
                 w->color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(w->png, COMPRESSION_LEVEL);
    png_write_info(w->png, w->info);
    if (w->bit_depth == 16) {
        png_set_swap(w->png); /* PNG is big-endian */
    }
    for (int32_t y = 0; y < w->height; y++) {
        png_write_row(w->png, w->data + (ptrdiff_t)y * w->stride);
    }
    png_write_end(w->png, w->info);
    return true;
}

static rlf_result write_picture(const char *path, writer *w)
{
    rlf_result result = io_out_open(&w->file, path);
    if (result != RLF_OK) {
        return result;
    }
    w->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, w, on_error, on_warning);
    w->info = w->png != NULL ? png_create_info_struct(w->png) : NULL;
    if (w->info == NULL) {
        result = rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory while writing it", path);
    } else if (!encode_or_jump(w) && w->file.write_errno == 0) {
        result = rlf_fail(RLF_ERROR_IO, "%s: libpng refuses to write it: %s", path, w->problem);
    }
    png_destroy_write_struct(&w->png, &w->info);
    return io_out_close(&w->file, result);
}

static bool is_size_usable(int32_t width, int32_t height)
{
    return width > 0 && height > 0 && width <= RLF_IMAGE_SIZE_MAX && height <= RLF_IMAGE_SIZE_MAX;
}

rlf_result rlf_png_write_rgba(const char *path, const rlf_image_rgba8 *image)
{
    if (!RLF_ASSERT(path != NULL && image != NULL && image->data != NULL) ||
        !RLF_ASSERT(is_size_usable(image->width, image->height))) {
        return RLF_ERROR_INVALID;
    }
    writer w = {.data = image->data,
                .width = image->width,
                .height = image->height,
                .stride = image->stride,
                .bit_depth = 8,
                .color_type = PNG_COLOR_TYPE_RGBA};
    return write_picture(path, &w);
}

rlf_result rlf_png_write_u8(const char *path, const rlf_plane_u8 *plane)
{
    if (!RLF_ASSERT(path != NULL && plane != NULL && plane->data != NULL) ||
        !RLF_ASSERT(is_size_usable(plane->width, plane->height))) {
        return RLF_ERROR_INVALID;
    }
    writer w = {.data = plane->data,
                .width = plane->width,
                .height = plane->height,
                .stride = plane->stride,
                .bit_depth = 8,
                .color_type = PNG_COLOR_TYPE_GRAY};
    return write_picture(path, &w);
}

rlf_result rlf_png_write_u16(const char *path, const uint16_t *data, int32_t width, int32_t height)
{
    if (!RLF_ASSERT(path != NULL && data != NULL) || !RLF_ASSERT(is_size_usable(width, height))) {
        return RLF_ERROR_INVALID;
    }
    writer w = {.data = (const uint8_t *)data,
                .width = width,
                .height = height,
                .stride = (ptrdiff_t)width * 2,
                .bit_depth = 16,
                .color_type = PNG_COLOR_TYPE_GRAY};
    return write_picture(path, &w);
}
