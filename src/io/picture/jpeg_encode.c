/* JPEG to memory through libturbojpeg. */
#include "io/picture/picture.h"

#include <turbojpeg.h>

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
