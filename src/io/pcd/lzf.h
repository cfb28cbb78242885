/* LZF, the compression of binary_compressed PCD files. */
#ifndef RLF_IO_PCD_LZF_H
#define RLF_IO_PCD_LZF_H

#include "relief/base.h"

/* No input gives more bytes than this times its size: a reference of three bytes copies 264. */
#define IO_LZF_RATIO_MAX 128

/* Fills exactly `size` bytes of `out`; false when the input does not give that many. */
bool io_lzf_decode(const uint8_t *in, size_t in_size, uint8_t *out, size_t size);

#endif
