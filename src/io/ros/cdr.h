/* Common Data Representation as ROS 2 has it: XCDR1 (OMG DDS-XTypes 1.3, 7.4), every number aligned
 * to its size from the first byte behind the head of 4. Readers also take big-endian and XCDR2, and
 * what ROS 1 writes: no head, no gaps, texts without an ending zero. */
#ifndef RLF_IO_ROS_CDR_H
#define RLF_IO_ROS_CDR_H

#include "io/codec/byte_buffer.h"

/* ---- writing: appends to a buffer ----------------------------------------------------------- */

typedef struct io_cdr_writer {
    io_byte_buffer *buffer;
    size_t start; /* of what is aligned */
} io_cdr_writer;

io_cdr_writer io_cdr_begin(io_byte_buffer *buffer);
void io_cdr_put_u8(io_cdr_writer *w, uint8_t value);
void io_cdr_put_u32(io_cdr_writer *w, uint32_t value);
void io_cdr_put_doubles(io_cdr_writer *w, const double *values, size_t count);
/* With its ending zero, as CDR has it. */
void io_cdr_put_text(io_cdr_writer *w, const char *text);
/* A sequence of bytes: what is appended to the buffer between the two calls. */
size_t io_cdr_begin_bytes(io_cdr_writer *w);
void io_cdr_end_bytes(io_cdr_writer *w, size_t begin);

/* ---- reading: any bytes --------------------------------------------------------------------- */

/* Past the end everything is 0 and `is_bad` is set. */
typedef struct io_cdr_reader {
    const uint8_t *data;
    size_t size, position;
    uint32_t align_max;
    bool is_swapped, is_ros1, is_bad;
} io_cdr_reader;

/* A piece of the message; borrowed from it. */
typedef struct io_cdr_span {
    const uint8_t *data;
    size_t size;
} io_cdr_span;

io_cdr_reader io_cdr_open(const uint8_t *data, size_t size);
io_cdr_reader io_ros1_open(const uint8_t *data, size_t size);
uint8_t io_cdr_get_u8(io_cdr_reader *r);
uint32_t io_cdr_get_u32(io_cdr_reader *r);
float io_cdr_get_float(io_cdr_reader *r);
void io_cdr_get_doubles(io_cdr_reader *r, double *out, size_t count);
/* Cut to what fits. */
void io_cdr_get_text(io_cdr_reader *r, char *out, size_t size);
io_cdr_span io_cdr_get_bytes(io_cdr_reader *r);

#endif
