/* Bytes of a small file, put together in memory. Include after cmocka.h. */
#ifndef RLF_TEST_BYTE_FILE_H
#define RLF_TEST_BYTE_FILE_H

#include <stdint.h>
#include <string.h>

#define BYTE_FILE_MAX (1 << 20)

typedef struct byte_file {
    uint8_t data[BYTE_FILE_MAX];
    size_t size;
} byte_file;

static inline void bytes_put(byte_file *b, const void *data, size_t size)
{
    if (size > 0 && size <= BYTE_FILE_MAX - b->size) {
        memcpy(b->data + b->size, data, size);
        b->size += size;
    }
}

static inline void bytes_u8(byte_file *b, uint8_t value)
{
    bytes_put(b, &value, 1);
}

static inline void bytes_u32(byte_file *b, uint32_t value)
{
    bytes_put(b, &value, 4);
}

static inline void bytes_u64(byte_file *b, uint64_t value)
{
    bytes_put(b, &value, 8);
}

static inline void bytes_f32(byte_file *b, float value)
{
    bytes_put(b, &value, 4);
}

static inline void bytes_f64(byte_file *b, double value)
{
    bytes_put(b, &value, 8);
}

/* The size, then the bytes. */
static inline void bytes_block(byte_file *b, const void *data, size_t size)
{
    bytes_u32(b, (uint32_t)size);
    bytes_put(b, data, size);
}

static inline void bytes_text(byte_file *b, const char *text)
{
    bytes_block(b, text, strlen(text));
}

#endif
