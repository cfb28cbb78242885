/* Bytes that are put together one after the other. */
#include "io/picture/picture.h"

#define CAPACITY_FIRST 4096

uint8_t *io_byte_buffer_reserve(io_byte_buffer *buffer, size_t size)
{
    if (buffer->is_short || size > SIZE_MAX / 4 - buffer->size) {
        buffer->is_short = true;
        return NULL;
    }
    const size_t need = buffer->size + size;
    if (need > buffer->capacity) {
        const size_t more = buffer->capacity + buffer->capacity / 2;
        const size_t capacity = need > more ? need + CAPACITY_FIRST : more;
        uint8_t *data = rlf_alloc(capacity);
        if (data == NULL) {
            buffer->is_short = true;
            return NULL;
        }
        if (buffer->size > 0) {
            memcpy(data, buffer->data, buffer->size);
        }
        rlf_free(buffer->data);
        buffer->data = data;
        buffer->capacity = capacity;
    }
    return buffer->data + buffer->size;
}

void io_byte_buffer_add(io_byte_buffer *buffer, const void *data, size_t size)
{
    uint8_t *out = io_byte_buffer_reserve(buffer, size);
    if (out != NULL && size > 0) {
        memcpy(out, data, size);
        buffer->size += size;
    }
}

rlf_result io_byte_buffer_check(const io_byte_buffer *buffer)
{
    return buffer->is_short ? rlf_fail(RLF_ERROR_MEMORY, "out of memory while writing: use a "
                                                         "smaller picture")
                            : RLF_OK;
}

void io_byte_buffer_free(io_byte_buffer *buffer)
{
    rlf_free(buffer->data);
    memset(buffer, 0, sizeof(*buffer));
}
