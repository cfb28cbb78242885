/* The points of a PCD file. */
#ifndef RLF_IO_PCD_POINTS_H
#define RLF_IO_PCD_POINTS_H

#include "io/pcd/pcd_header.h"

/* Planes of width * height, row by row; a missing point is NAN. Free with io_pcd_points_free. */
typedef struct io_pcd_points {
    float *x, *y, *z;
    uint8_t *rgba; /* NULL = no colour */
} io_pcd_points;

rlf_result io_pcd_points_read(const io_bytes *file, const io_pcd_header *header,
                              io_pcd_points *out);
void io_pcd_points_free(io_pcd_points *points);

#endif
