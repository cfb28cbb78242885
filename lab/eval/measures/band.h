/* The pixels at depth edges. */
#ifndef RELIEF_APP_EVAL_MEASURES_BAND_H
#define RELIEF_APP_EVAL_MEASURES_BAND_H

#include <stdint.h>

/* Marks pixels within 6 of a jump (neighbours whose depths differ by more than 4 % of the nearer).
 * out and scratch hold width * height bytes. */
void eval_mark_band(const float *depth, int32_t width, int32_t height, uint8_t *out,
                    uint8_t *scratch);

#endif
