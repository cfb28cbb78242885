/* Pictures of either kind. */
#include "relief/io.h"
#include "io/picture/picture.h"

#include <string.h>

rlf_result io_picture_decode(const io_bytes *file, io_picture *picture)
{
    if (file->size == 0) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is empty (0 bytes): copy or record it again",
                        file->name);
    }
    if (io_png_is(file)) {
        return io_png_decode_rgba(file, picture);
    }
    if (file->size >= 2 && file->data[0] == 0xFF && file->data[1] == 0xD8) {
        return io_jpeg_decode_rgba(file, picture);
    }
    return rlf_fail(RLF_ERROR_FORMAT, "%s: is neither PNG nor JPEG: convert it to one of them",
                    file->name);
}

static int32_t number_at(const uint8_t *data)
{
    return (int32_t)((uint32_t)data[0] << 24 | (uint32_t)data[1] << 16 | (uint32_t)data[2] << 8 |
                     data[3]);
}

bool io_picture_size(const io_bytes *file, int32_t *out_width, int32_t *out_height)
{
    if (!io_png_is(file)) {
        return io_jpeg_size(file, out_width, out_height);
    }
    if (file->size < 24) { /* the signature, a chunk's length and name, width and height */
        return false;
    }
    *out_width = number_at(file->data + 16);
    *out_height = number_at(file->data + 20);
    return true;
}

typedef rlf_result (*decode_fn)(const io_bytes *file, io_picture *picture);

/* A picture of up to IO_PICTURE_FILE_MAX bytes; the caller frees its data. */
static rlf_result read_with(decode_fn decode, const char *path, io_picture *out)
{
    io_buffer buffer = {0};
    io_bytes file;
    *out = (io_picture){0};
    rlf_result result =
        io_file_read(path, IO_PICTURE_FILE_MAX, "check the name of the picture", &buffer, &file);
    result = result == RLF_OK ? decode(&file, out) : result;
    io_buffer_free(&buffer);
    return result;
}

rlf_result rlf_picture_read(const char *path, rlf_image_rgba8 *out)
{
    if (!RLF_ASSERT(path != NULL && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    memset(out, 0, sizeof(*out));
    io_picture picture;
    rlf_result result = read_with(io_picture_decode, path, &picture);
    if (result == RLF_OK) {
        *out = (rlf_image_rgba8){picture.data, picture.width, picture.height,
                                 (ptrdiff_t)picture.width * 4};
    }
    return result;
}

static rlf_result read_u16(const char *path, decode_fn decode, uint16_t **out, int32_t *out_width,
                           int32_t *out_height)
{
    if (!RLF_ASSERT(path != NULL && out != NULL && out_width != NULL && out_height != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    io_picture picture;
    rlf_result result = read_with(decode, path, &picture);
    if (result == RLF_OK) {
        *out = picture.data;
        *out_width = picture.width;
        *out_height = picture.height;
    }
    return result;
}

rlf_result rlf_png_read_u16(const char *path, uint16_t **out, int32_t *out_width,
                            int32_t *out_height)
{
    return read_u16(path, io_png_decode_u16, out, out_width, out_height);
}

rlf_result rlf_png_read_rgb_u16(const char *path, uint16_t **out, int32_t *out_width,
                                int32_t *out_height)
{
    return read_u16(path, io_png_decode_rgb_u16, out, out_width, out_height);
}
