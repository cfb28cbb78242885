/* Numbers of files are little-endian, whatever the machine. */
#ifndef RLF_IO_LITTLE_H
#define RLF_IO_LITTLE_H

#include "relief/base.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define IO_IS_BIG_ENDIAN 1
#else
#define IO_IS_BIG_ENDIAN 0
#endif

/* Turns `count` numbers of `size` bytes, in place, from this machine's order to that of files, or
 * back. */
static inline void io_little(void *numbers, size_t count, size_t size)
{
    uint8_t *bytes = numbers;
    for (size_t i = 0; IO_IS_BIG_ENDIAN && i < count; i++, bytes += size) {
        for (size_t k = 0; k < size / 2; k++) {
            const uint8_t byte = bytes[k];
            bytes[k] = bytes[size - 1 - k];
            bytes[size - 1 - k] = byte;
        }
    }
}

/* One number of a file. */
static inline void io_little_read(const void *bytes, void *out, size_t size)
{
    memcpy(out, bytes, size);
    io_little(out, 1, size);
}

/* ---- Bounded reading of little-endian values ---- */

/* What is read past the end is zero and makes is_short true: one check at the end is enough. */
typedef struct cursor {
    const uint8_t *data;
    size_t left;
    bool is_short;
} cursor;

/* The next `size` bytes, or NULL. */
static inline const uint8_t *cursor_take(cursor *c, size_t size)
{
    if (size > c->left) {
        c->is_short = true;
        c->left = 0;
        return NULL;
    }
    const uint8_t *at = c->data;
    if (size > 0) { /* where nothing is left there may be no bytes to point to */
        c->data += size;
        c->left -= size;
    }
    return at;
}

static inline uint8_t cursor_u8(cursor *c)
{
    const uint8_t *at = cursor_take(c, 1);
    return at != NULL ? at[0] : 0;
}

static inline uint16_t cursor_u16(cursor *c)
{
    const uint8_t low = cursor_u8(c);
    return (uint16_t)(low | cursor_u8(c) << 8);
}

static inline uint32_t cursor_u32(cursor *c)
{
    uint32_t value = 0;
    const uint8_t *at = cursor_take(c, sizeof(value));
    if (at != NULL) {
        io_little_read(at, &value, sizeof(value));
    }
    return value;
}

static inline uint64_t cursor_u64(cursor *c)
{
    uint64_t value = 0;
    const uint8_t *at = cursor_take(c, sizeof(value));
    if (at != NULL) {
        io_little_read(at, &value, sizeof(value));
    }
    return value;
}

static inline float cursor_f32(cursor *c)
{
    float value = 0.0f;
    const uint8_t *at = cursor_take(c, sizeof(value));
    if (at != NULL) {
        io_little_read(at, &value, sizeof(value));
    }
    return value;
}

static inline double cursor_f64(cursor *c)
{
    double value = 0.0;
    const uint8_t *at = cursor_take(c, sizeof(value));
    if (at != NULL) {
        io_little_read(at, &value, sizeof(value));
    }
    return value;
}

/* A string or an array of bytes: its length first. */
static inline cursor cursor_block(cursor *c)
{
    const size_t size = cursor_u32(c);
    const uint8_t *at = cursor_take(c, size);
    return (cursor){at, at != NULL ? size : 0, false};
}

/* A copy of all that is left as text, cut at capacity - 1. */
static inline void cursor_copy(cursor text, char *out, size_t capacity)
{
    const size_t size = text.left < capacity ? text.left : capacity - 1;
    if (size > 0) {
        memcpy(out, text.data, size);
    }
    out[size] = '\0';
}

/* A string's copy. */
static inline void cursor_text(cursor *c, char *out, size_t capacity)
{
    cursor_copy(cursor_block(c), out, capacity);
}

/* Seconds and nanoseconds, as ROS 1 serialises them. */
static inline int64_t cursor_time(cursor *c)
{
    const int64_t seconds = cursor_u32(c);
    return seconds * 1000000000 + cursor_u32(c);
}

#endif
