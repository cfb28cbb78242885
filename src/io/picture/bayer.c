/* Pictures straight from a sensor with a colour filter over each pixel. */
#include "io/picture/pixels.h"

/* 0 red, 1 green, 2 blue. */
static int32_t color_at(int32_t x, int32_t y, int32_t red_x, int32_t red_y)
{
    return ((x ^ red_x) & 1) + ((y ^ red_y) & 1);
}

/* Adds up the colours of the 3x3 pixels around; of the pixel's own colour only itself counts. */
static void add_around(const io_pixels *in, const int32_t at[2], const int32_t red[2],
                       int32_t sum[3], int32_t count[3])
{
    const int32_t own = color_at(at[0], at[1], red[0], red[1]);
    for (int32_t y = at[1] - 1; y <= at[1] + 1; y++) {
        for (int32_t x = at[0] - 1; x <= at[0] + 1; x++) {
            if (x < 0 || y < 0 || x >= (int32_t)in->width || y >= (int32_t)in->height) {
                continue;
            }
            const int32_t color = color_at(x, y, red[0], red[1]);
            if (color != own || (x == at[0] && y == at[1])) {
                sum[color] += in->data[y * in->step + x];
                count[color]++;
            }
        }
    }
}

void io_bayer_row(const io_pixels *in, int32_t red_x, int32_t red_y, int32_t y, uint8_t *out)
{
    const int32_t red[2] = {red_x, red_y};
    for (int32_t x = 0; x < (int32_t)in->width; x++) {
        const int32_t at[2] = {x, y};
        int32_t sum[3] = {0};
        int32_t count[3] = {0};
        add_around(in, at, red, sum, count);
        for (int i = 0; i < 3; i++) {
            out[4 * x + i] = count[i] > 0 ? (uint8_t)((sum[i] + count[i] / 2) / count[i]) : 0;
        }
        out[4 * x + 3] = 255;
    }
}
