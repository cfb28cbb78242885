/* Organised point clouds of PCL. */
#ifndef RLF_IO_FORMATS_PCD_H
#define RLF_IO_FORMATS_PCD_H

#include "io/file.h"
#include "relief/base.h"
#include "relief/camera.h"

/* ---- The header of a PCD file (Point Cloud Library, version 0.7) ---- */

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

/* ---- The points of a PCD file ---- */

/* Planes of width * height, row by row; a missing point is NAN. Free with io_pcd_points_free. */
typedef struct io_pcd_points {
    float *x, *y, *z;
    uint8_t *rgba; /* NULL = no colour */
} io_pcd_points;

rlf_result io_pcd_points_read(const io_bytes *file, const io_pcd_header *header,
                              io_pcd_points *out);
void io_pcd_points_free(io_pcd_points *points);

/* ---- The camera that an organised cloud was made with ---- */

/* Pinhole of u = fx x / z + cx and v = fy y / z + cy by least squares over all points. False when
 * the points do not lie so to a tenth of a pixel (root mean square), or are too few. */
bool io_pcd_lens_fit(const io_pcd_header *header, const io_pcd_points *points, rlf_camera *out);

/* ---- LZF, the compression of binary_compressed PCD files ---- */

/* No input gives more bytes than this times its size: a reference of three bytes copies 264. */
#define IO_LZF_RATIO_MAX 128

/* Fills exactly `size` bytes of `out`; false when the input does not give that many. */
bool io_lzf_decode(const uint8_t *in, size_t in_size, uint8_t *out, size_t size);

#endif
