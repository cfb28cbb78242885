/* Letters of 5 x 7 dots. */
#ifndef RLF_RENDER_SOFT_FONT_H
#define RLF_RENDER_SOFT_FONT_H

#include <stdint.h>

extern const uint8_t soft_font[95][7]; /* ' ' to '~', rows from the top, bit 4 is left */

#endif
