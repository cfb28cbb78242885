/* Whether a raw picture holds what its header says. */
#ifndef RLF_IO_PIXELS_CHECK_H
#define RLF_IO_PIXELS_CHECK_H

#include "io/pixels/pixels.h"

/* The picture has a size within the limits and `row_count` whole rows of width x pixel_size bytes:
 * half as many again as the height where planes of colour follow. */
rlf_result io_pixels_check(const io_pixels *in, int32_t pixel_size, int64_t row_count);

#endif
