/* Lossless code for depth pictures: RVL (Wilson, "Fast Lossless Depth Image Compression", 2017).
 *
 * Runs of missing and of measured pixels in turn; measured ones as differences to the one before,
 * zigzag, in nibbles of three bits and a flag. The bytes are those that ROS calls "rvl". */
#ifndef RLF_IO_CODEC_RVL_H
#define RLF_IO_CODEC_RVL_H

#include "relief/base.h"

#define IO_RVL_WINDOW 4096 /* all values of three nibbles */
#define IO_RVL_SHORT 512   /* zigzag values that fit three nibbles */

/* What three nibbles say: up to three whole differences. */
typedef struct io_rvl_entry {
    int16_t sum[3]; /* of the first one, two, three of them; repeated when there are fewer */
    uint8_t count;  /* 0 = the first does not end here */
    uint8_t bits;   /* of all of them */
} io_rvl_entry;

/* Tables of both directions; constant once made, so threads may share them. */
typedef struct io_rvl {
    io_rvl_entry decode[IO_RVL_WINDOW];
    uint16_t encode[IO_RVL_SHORT]; /* nibbles, with their number times 4096 */
} io_rvl;

void io_rvl_init(io_rvl *rvl);

/* Most bytes that `count` pixels can take. */
size_t io_rvl_bound(size_t count);
/* Writes at most io_rvl_bound bytes and returns how many. */
size_t io_rvl_encode(const io_rvl *rvl, const uint16_t *depth, size_t count, uint8_t *out);
/* Reads exactly `count` pixels; false when the bytes end before or say more than that. Whatever the
 * bytes are, nothing else is read or written. */
bool io_rvl_decode(const io_rvl *rvl, const uint8_t *data, size_t size, uint16_t *out,
                   size_t count);

#endif
