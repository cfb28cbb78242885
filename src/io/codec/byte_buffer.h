/* Bytes that are put together one after the other. */
#ifndef RLF_IO_CODEC_BYTE_BUFFER_H
#define RLF_IO_CODEC_BYTE_BUFFER_H

#include "relief/base.h"
#include "io/little.h"

#include <string.h>

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

#endif
