/* JPEG from memory through libturbojpeg. */
#include "io/picture/picture.h"

#include <string.h>
#include <turbojpeg.h>

/* A Huffman-coded block of 8x8 pixels takes at least one bit; four times that for safety. */
#define JPEG_PIXELS_PER_BYTE (64 * 8 * 4)

/* The end marker, perhaps followed by zeros: nothing was cut off. */
static bool has_end(const io_bytes *file)
{
    size_t size = file->size;
    while (size > 0 && file->data[size - 1] == 0) {
        size--;
    }
    return size >= 2 && file->data[size - 2] == 0xFF && file->data[size - 1] == 0xD9;
}

/* Cameras that deliver MJPEG often put stray bytes between the picture and its end marker. They
 * harm nothing; every other warning means lost pixels. */
static bool is_harmless(tjhandle handle, const io_bytes *file)
{
    return tjGetErrorCode(handle) == TJERR_WARNING &&
           strstr(tjGetErrorStr2(handle), "extraneous bytes") != NULL && has_end(file);
}

static rlf_result fail_damaged(tjhandle handle, const io_bytes *file)
{
    return rlf_fail(RLF_ERROR_FORMAT,
                    "%s: the JPEG is damaged or cut short (%s): copy or record it again",
                    file->name, tjGetErrorStr2(handle));
}

static rlf_result decode(tjhandle handle, const io_bytes *file, io_picture *picture)
{
    int width = 0;
    int height = 0;
    int subsampling = 0;
    int colorspace = 0;
    if (tjDecompressHeader3(handle, file->data, (unsigned long)file->size, &width, &height,
                            &subsampling, &colorspace) != 0) {
        return fail_damaged(handle, file);
    }
    if (colorspace == TJCS_CMYK || colorspace == TJCS_YCCK) {
        return rlf_fail(RLF_ERROR_FORMAT, "%s: is a CMYK JPEG: convert it to RGB", file->name);
    }
    bool owns_data = picture->data == NULL;
    rlf_result result = io_picture_prepare(file, picture, width, height, JPEG_PIXELS_PER_BYTE, 4);
    if (result != RLF_OK) {
        return result;
    }
    int status = tjDecompress2(handle, file->data, (unsigned long)file->size, picture->data, width,
                               width * 4, height, TJPF_RGBA, TJFLAG_LIMITSCANS);
    if (status == 0 || is_harmless(handle, file)) {
        return RLF_OK;
    }
    if (owns_data) {
        rlf_free(picture->data);
        picture->data = NULL;
    }
    return fail_damaged(handle, file);
}

bool io_jpeg_size(const io_bytes *file, int32_t *out_width, int32_t *out_height)
{
    int subsampling = 0;
    int colorspace = 0;
    tjhandle handle = file->size > 0 ? tjInitDecompress() : NULL;
    const bool is_read = handle != NULL &&
                         tjDecompressHeader3(handle, file->data, (unsigned long)file->size,
                                             out_width, out_height, &subsampling, &colorspace) == 0;
    if (handle != NULL) {
        tjDestroy(handle);
    }
    return is_read;
}

rlf_result io_jpeg_decode_rgba(const io_bytes *file, io_picture *picture)
{
    tjhandle handle = tjInitDecompress();
    if (handle == NULL) {
        return rlf_fail(RLF_ERROR_MEMORY, "%s: out of memory while reading it", file->name);
    }
    rlf_result result = decode(handle, file, picture);
    tjDestroy(handle);
    return result;
}

/* ---- writing ----------------------------------------------------------------------------- */

struct io_jpeg_encoder {
    tjhandle handle;
};

rlf_result io_jpeg_encoder_create(io_jpeg_encoder **out)
{
    io_jpeg_encoder *encoder = rlf_alloc(sizeof(*encoder));
    *out = NULL;
    if (encoder == NULL) {
        return RLF_ERROR_MEMORY;
    }
    encoder->handle = tjInitCompress();
    if (encoder->handle == NULL) {
        rlf_free(encoder);
        return rlf_fail(RLF_ERROR_MEMORY, "out of memory for the JPEG encoder");
    }
    *out = encoder;
    return RLF_OK;
}

void io_jpeg_encoder_destroy(io_jpeg_encoder **encoder)
{
    if (*encoder != NULL) {
        tjDestroy((*encoder)->handle);
        rlf_free(*encoder);
        *encoder = NULL;
    }
}

rlf_result io_jpeg_encode(io_jpeg_encoder *encoder, const rlf_image_rgba8 *image, int32_t quality,
                          io_byte_buffer *out)
{
    const unsigned long bound = tjBufSize(image->width, image->height, TJSAMP_420);
    unsigned char *data = io_byte_buffer_reserve(out, bound);
    unsigned long size = bound;
    if (data == NULL) {
        return io_byte_buffer_check(out);
    }
    if (tjCompress2(encoder->handle, image->data, image->width, (int)image->stride, image->height,
                    TJPF_RGBX, &data, &size, TJSAMP_420, quality, TJFLAG_NOREALLOC) != 0) {
        return rlf_fail(RLF_ERROR_IO, "libturbojpeg refuses to write a picture of %d x %d: %s",
                        (int)image->width, (int)image->height, tjGetErrorStr2(encoder->handle));
    }
    io_byte_buffer_grow(out, size);
    return RLF_OK;
}
