/* Bounded reading of little-endian values. */
#ifndef RLF_IO_CLIP_CURSOR_H
#define RLF_IO_CLIP_CURSOR_H

#include "io/little.h"
#include "relief/base.h"

#include <string.h>

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

/* A string's copy, cut at capacity - 1. */
static inline void cursor_text(cursor *c, char *out, size_t capacity)
{
    const cursor text = cursor_block(c);
    const size_t size = text.left < capacity ? text.left : capacity - 1;
    if (size > 0) {
        memcpy(out, text.data, size);
    }
    out[size] = '\0';
}

/* Seconds and nanoseconds, as ROS 1 serialises them. */
static inline int64_t cursor_time(cursor *c)
{
    const int64_t seconds = cursor_u32(c);
    return seconds * 1000000000 + cursor_u32(c);
}

#endif
