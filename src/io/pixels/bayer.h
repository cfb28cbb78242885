/* Pictures straight from a sensor with a colour filter over each pixel (Bayer pattern). */
#ifndef RLF_IO_BAYER_H
#define RLF_IO_BAYER_H

#include "io/pixels/pixels.h"

/* Row y as RGBA: each missing colour is the mean of that colour's nearest pixels (bilinear). The
 * first red pixel is at (red_x, red_y), each 0 or 1. */
void io_bayer_row(const io_pixels *in, int32_t red_x, int32_t red_y, int32_t y, uint8_t *out);

#endif
