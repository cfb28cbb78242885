/* Common Data Representation. */
#include "io/ros/messages.h"
#include "io/little.h"

#define HEAD 4

/* ---- writing -------------------------------------------------------------------------------- */

io_cdr_writer io_cdr_begin(io_byte_buffer *buffer)
{
    static const uint8_t head[HEAD] = {0, 1, 0, 0}; /* little-endian, plain */
    io_byte_buffer_add(buffer, head, HEAD);
    return (io_cdr_writer){buffer, buffer->size};
}

static void align(io_cdr_writer *w, size_t to)
{
    static const uint8_t zeros[8] = {0};
    const size_t over = (w->buffer->size - w->start) % to;
    io_byte_buffer_add(w->buffer, zeros, over > 0 ? to - over : 0);
}

void io_cdr_put_u8(io_cdr_writer *w, uint8_t value)
{
    io_put_u8(w->buffer, value);
}

void io_cdr_put_u32(io_cdr_writer *w, uint32_t value)
{
    align(w, 4);
    io_put_u32(w->buffer, value);
}

void io_cdr_put_doubles(io_cdr_writer *w, const double *values, size_t count)
{
    align(w, 8);
    for (size_t i = 0; i < count; i++) {
        double value = values[i];
        io_little(&value, 1, sizeof(value));
        io_byte_buffer_add(w->buffer, &value, sizeof(value));
    }
}

void io_cdr_put_text(io_cdr_writer *w, const char *text)
{
    io_cdr_put_u32(w, (uint32_t)strlen(text) + 1);
    io_byte_buffer_add(w->buffer, text, strlen(text) + 1);
}

size_t io_cdr_begin_bytes(io_cdr_writer *w)
{
    io_cdr_put_u32(w, 0);
    return w->buffer->size;
}

void io_cdr_end_bytes(io_cdr_writer *w, size_t begin)
{
    uint32_t size = (uint32_t)(w->buffer->size - begin);
    io_little(&size, 1, sizeof(size));
    if (!w->buffer->is_short) {
        memcpy(w->buffer->data + begin - sizeof(size), &size, sizeof(size));
    }
}

/* ---- reading -------------------------------------------------------------------------------- */

io_cdr_reader io_ros1_open(const uint8_t *data, size_t size)
{
    return (io_cdr_reader){.data = data, .size = size, .align_max = 1, .is_ros1 = true};
}

io_cdr_reader io_cdr_open(const uint8_t *data, size_t size)
{
    io_cdr_reader r = {.align_max = 8, .is_bad = true};
    if (size < HEAD || data[0] != 0) {
        return r;
    }
    /* 0 and 1: plain; 6 and 7: plain of version 2. The odd ones are little-endian. */
    const uint8_t kind = data[1];
    r.is_bad = kind != 0 && kind != 1 && kind != 6 && kind != 7;
    r.is_swapped = (kind & 1) == 0;
    r.align_max = kind >= 6 ? 4 : 8;
    r.data = data + HEAD;
    r.size = size - HEAD;
    return r;
}

static const uint8_t *take(io_cdr_reader *r, size_t size, size_t alignment)
{
    const size_t to = alignment < r->align_max ? alignment : r->align_max;
    const size_t begin = (r->position + to - 1) / to * to;
    if (r->is_bad || begin > r->size || size > r->size - begin) {
        r->is_bad = true;
        return NULL;
    }
    r->position = begin + size;
    return r->data + begin;
}

static void take_number(io_cdr_reader *r, void *out, size_t size)
{
    const uint8_t *data = take(r, size, size);
    uint8_t *bytes = out;
    for (size_t i = 0; i < size; i++) {
        bytes[i] = data == NULL ? 0 : data[r->is_swapped != IO_IS_BIG_ENDIAN ? size - 1 - i : i];
    }
}

uint8_t io_cdr_get_u8(io_cdr_reader *r)
{
    const uint8_t *data = take(r, 1, 1);
    return data != NULL ? *data : 0;
}

uint32_t io_cdr_get_u32(io_cdr_reader *r)
{
    uint32_t value;
    take_number(r, &value, sizeof(value));
    return value;
}

float io_cdr_get_float(io_cdr_reader *r)
{
    float value;
    take_number(r, &value, sizeof(value));
    return value;
}

void io_cdr_get_doubles(io_cdr_reader *r, double *out, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        take_number(r, &out[i], sizeof(out[i]));
    }
}

void io_cdr_get_text(io_cdr_reader *r, char *out, size_t size)
{
    const io_cdr_span text = io_cdr_get_bytes(r);
    const size_t zero = r->is_ros1 || text.size == 0 ? 0 : 1;
    const size_t whole = text.size - zero;
    const size_t length = whole < size - 1 ? whole : size - 1;
    if (length > 0) {
        memcpy(out, text.data, length);
    }
    out[length] = '\0';
}

io_cdr_span io_cdr_get_bytes(io_cdr_reader *r)
{
    const uint32_t size = io_cdr_get_u32(r);
    const uint8_t *data = take(r, size, 1);
    return (io_cdr_span){data, data != NULL ? size : 0};
}
