/* Pictures as video encoders want them: planar YUV 4:2:0. */
#ifndef RLF_IO_YUV_H
#define RLF_IO_YUV_H

#include "relief/image.h"

/* Limited range (16..235), BT.601 matrix, chroma in the middle of each 2x2 block. Width and height
 * are even; planes have no padding and lie in one rlf_alloc block. */
typedef struct io_yuv {
    int32_t width, height;
    uint8_t *y, *u, *v;
} io_yuv;

/* Room for a picture of width x height, each rounded up to even. */
rlf_result io_yuv_create(int32_t width, int32_t height, io_yuv *out);
void io_yuv_destroy(io_yuv *yuv);
size_t io_yuv_size(const io_yuv *yuv);

/* Converts; the last column and row are repeated where the picture's size is odd. Alpha is not
 * used. */
void io_yuv_from_rgba(const rlf_image_rgba8 *image, io_yuv *yuv);

/* Frame rate as a fraction. */
typedef struct io_rate {
    int32_t numerator, denominator;
} io_rate;

/* 29.97 and its kin as N * 1000 / 1001, others to a thousandth. */
io_rate io_rate_from(double frames_per_second);

#endif
