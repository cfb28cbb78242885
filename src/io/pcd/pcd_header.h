/* The header of a PCD file (Point Cloud Library, version 0.7). */
#ifndef RLF_IO_PCD_HEADER_H
#define RLF_IO_PCD_HEADER_H

#include "io/file.h"

#define IO_PCD_FIELDS_MAX 32

typedef enum io_pcd_data {
    IO_PCD_ASCII = 0,
    IO_PCD_BINARY = 1,
    IO_PCD_COMPRESSED = 2 /* LZF, field by field */
} io_pcd_data;

/* What a point holds. */
typedef struct io_pcd_field {
    char name[16];
    int32_t size, count; /* bytes of one number, how many of them */
    char type;           /* F, I or U */
    size_t offset;       /* in a point, bytes; of ASCII: its place among the words */
} io_pcd_field;

typedef struct io_pcd_header {
    io_pcd_field fields[IO_PCD_FIELDS_MAX];
    int32_t field_count;
    int32_t width, height;
    size_t point_size; /* bytes; of ASCII: words */
    io_pcd_data data;
    size_t data_offset; /* where the points begin in the file */
} io_pcd_header;

/* Fails on what is no organised cloud of points with x, y and z. */
rlf_result io_pcd_header_parse(const io_bytes *file, io_pcd_header *out);

/* NULL when there is none. */
const io_pcd_field *io_pcd_field_find(const io_pcd_header *header, const char *name);

#endif
