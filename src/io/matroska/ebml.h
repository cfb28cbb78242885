/* Elements of EBML (RFC 8794), of which Matroska (RFC 9559) files are made. */
#ifndef RLF_IO_MATROSKA_EBML_H
#define RLF_IO_MATROSKA_EBML_H

#include "relief/base.h"

typedef struct ebml_element {
    uint32_t id;
    int32_t header_size; /* bytes in front of the data */
    int64_t size;        /* of the data; -1 = not known: up to the next element of its level */
} ebml_element;

/* Longest header of an element: id and size. */
#define EBML_HEADER_MAX 12

/* Reads the header of an element; false when the bytes are none. */
bool ebml_read(const uint8_t *data, size_t size, ebml_element *out);

/* Variable-length number, without its marker; returns its length, 0 when it is none. */
int32_t ebml_number(const uint8_t *data, size_t size, uint64_t *out, bool *out_is_unknown);

/* Unsigned integer of `size` bytes, most significant first. */
uint64_t ebml_unsigned(const uint8_t *data, size_t size);

#endif
