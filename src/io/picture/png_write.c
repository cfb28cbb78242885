/* PNG files. */
#include "relief/io.h"
#include "io/picture/picture.h"
#include "io/file.h"

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
    if (result == RLF_OK) {
        result = rlf_file_write(def->name, buffer.data, buffer.size);
    }
    io_byte_buffer_free(&buffer);
    return result;
}

rlf_result rlf_png_write_rgba(const char *path, const rlf_image_rgba8 *image)
{
    if (!RLF_ASSERT(path != NULL && image != NULL && image->data != NULL) ||
        !RLF_ASSERT(is_size_usable(image->width, image->height))) {
        return RLF_ERROR_INVALID;
    }
    const io_png_def def = {path,          image->data, image->width,     image->height,
                            image->stride, IO_PNG_RGBA, COMPRESSION_LEVEL};
    return write_picture(&def);
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
