/* Shrinking and writing pictures. */
#include "picture_file.h"

/* Mean of a channel over the block of a small picture's pixel. */
static uint8_t mean_of(const rlf_image_rgba8 *image, int32_t factor, int32_t x, int32_t y,
                       int channel)
{
    int32_t sum = factor * factor / 2;
    for (int32_t k = 0; k < factor; k++) {
        const uint8_t *row = rlf_rgba8_row(image, y * factor + k);
        for (int32_t i = 0; i < factor; i++) {
            sum += row[4 * (x * factor + i) + channel];
        }
    }
    return (uint8_t)(sum / (factor * factor));
}

rlf_result picture_file_write(const char *path, const rlf_image_rgba8 *image, int32_t factor)
{
    if (factor == 1) {
        return rlf_png_write_premultiplied(path, image);
    }
    rlf_image_rgba8 small = {.width = image->width / factor, .height = image->height / factor};
    if (small.width < 1 || small.height < 1) {
        return rlf_fail(RLF_ERROR_INVALID, "%s: %dx%d shrunk %d times leaves nothing", path,
                        (int)image->width, (int)image->height, (int)factor);
    }
    small.stride = 4 * (ptrdiff_t)small.width;
    small.data = rlf_alloc_array((size_t)small.width * (size_t)small.height, 4);
    if (small.data == NULL) {
        return RLF_ERROR_MEMORY;
    }
    for (int32_t y = 0; y < small.height; y++) {
        uint8_t *row = rlf_rgba8_row(&small, y);
        for (int32_t i = 0; i < 4 * small.width; i++) {
            row[i] = mean_of(image, factor, i / 4, y, i % 4);
        }
    }
    rlf_result result = rlf_png_write_premultiplied(path, &small);
    rlf_free(small.data);
    return result;
}
