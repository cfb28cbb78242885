/* The last step of a row. */
#ifndef RLF_RENDER_SOFT_COMPOSE_H
#define RLF_RENDER_SOFT_COMPOSE_H

#include "render/soft/soft.h"

/* Puts sums (red, green, blue, shown; whole lanes) over `count` pixels. */
void soft_compose_row(float *const sum[4], int32_t count, uint8_t *restrict pixels,
                      uint8_t *restrict matte);

#endif
