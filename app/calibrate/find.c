/* Pictures as grey, and the board in them. */
#include "calibrate/views.h"

#include "relief/io.h"

#include <string.h>

/* An edge wider than this share of the pitch fills the window in which its corner is measured. */
#define RISE_MAX 0.5

static rlf_result gray_create(int32_t width, int32_t height, calibrate_gray *out)
{
    *out = (calibrate_gray){.width = width, .height = height};
    out->data = rlf_alloc_array((size_t)width, (size_t)height);
    return out->data != NULL ? RLF_OK : RLF_ERROR_MEMORY;
}

rlf_result calibrate_gray_from_rgba(const rlf_image_rgba8 *image, calibrate_gray *out)
{
    rlf_result result = gray_create(image->width, image->height, out);
    for (int32_t y = 0; result == RLF_OK && y < image->height; y++) {
        const uint8_t *row = rlf_rgba8_row(image, y);
        for (int32_t x = 0; x < image->width; x++) {
            const uint8_t *p = &row[4 * x];
            out->data[(size_t)y * (size_t)image->width + (size_t)x] =
                (uint8_t)((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
        }
    }
    return result;
}

/* The value that 199 of 200 pixels do not pass. */
static uint32_t bright_value(const uint16_t *data, size_t count)
{
    static const uint32_t shift = 4; /* bins of 16 counts */
    uint32_t bins[4096] = {0};
    for (size_t i = 0; i < count; i++) {
        bins[data[i] >> shift]++;
    }
    size_t above = 0;
    uint32_t bin = 4095;
    while (bin > 0 && (above += bins[bin]) * 200 < count) {
        bin--;
    }
    return (bin + 1) << shift;
}

static rlf_result stretch(const uint16_t *data, int32_t width, int32_t height, calibrate_gray *out)
{
    const size_t count = (size_t)width * (size_t)height;
    rlf_result result = gray_create(width, height, out);
    const uint32_t bright = bright_value(data, count);
    for (size_t i = 0; result == RLF_OK && i < count; i++) {
        const uint32_t value = 255 * (uint32_t)data[i] / bright;
        out->data[i] = (uint8_t)(value < 255 ? value : 255);
    }
    return result;
}

rlf_result calibrate_gray_read(const char *path, calibrate_gray *out)
{
    uint16_t *data = NULL;
    int32_t width, height;
    rlf_result result;
    if (rlf_png_read_u16(path, &data, &width, &height) == RLF_OK) {
        result = stretch(data, width, height, out);
        rlf_free(data);
        return result;
    }
    rlf_image_rgba8 image = {.data = NULL};
    result = rlf_picture_read(path, &image);
    if (result == RLF_OK) {
        result = calibrate_gray_from_rgba(&image, out);
        rlf_free(image.data);
    }
    return result;
}

static relief_opencv_board board_of(const calibrate_board *board)
{
    return (relief_opencv_board){.columns = board->columns,
                                 .rows = board->rows,
                                 .square = board->square_m,
                                 .marker = board->marker_m,
                                 .is_charuco = board->is_charuco,
                                 .dictionary = board->dictionary,
                                 .is_quick = board->is_quick};
}

static relief_opencv_gray gray_of(const calibrate_gray *gray)
{
    return (relief_opencv_gray){gray->data, gray->width, gray->height};
}

calibrate_found calibrate_find(const relief_opencv_api *api, const calibrate_gray *gray,
                               const calibrate_board *board, calibrate_sight *sight)
{
    const relief_opencv_board wanted = board_of(board);
    const relief_opencv_gray image = gray_of(gray);
    relief_opencv_corners found;
    const int state = api->find(&image, &wanted, &found);
    if (state < 0) {
        rlf_fail(RLF_ERROR_INVALID, "%.200s", api->error());
        return CALIBRATE_FAILED;
    }
    if (state == 0) {
        return CALIBRATE_ABSENT;
    }
    if (found.rise > RISE_MAX * found.pitch) {
        return CALIBRATE_BLURRED;
    }
    if (calibrate_sight_resize(sight, found.count) != RLF_OK) {
        return CALIBRATE_FAILED;
    }
    for (int32_t i = 0; i < found.count; i++) {
        calibrate_point *p = &sight->points[i];
        calibrate_board_point(board, found.id[i], &p->x, &p->y);
        p->u = found.u[i];
        p->v = found.v[i];
    }
    return CALIBRATE_FOUND;
}

bool calibrate_find_larger(const relief_opencv_api *api, const calibrate_gray *gray,
                           const calibrate_board *board, int32_t *out_columns, int32_t *out_rows)
{
    const relief_opencv_board wanted = board_of(board);
    const relief_opencv_gray image = gray_of(gray);
    return !board->is_charuco && api->size(&image, &wanted, out_columns, out_rows) == 1 &&
           *out_columns * *out_rows > board->columns * board->rows;
}

bool calibrate_find_other(const relief_opencv_api *api, const calibrate_gray *gray,
                          const calibrate_board *board, int32_t *out_columns, int32_t *out_rows)
{
    calibrate_board least = *board;
    least.is_charuco = false;
    least.columns = 3;
    least.rows = 3;
    const bool is_found = calibrate_find_larger(api, gray, &least, out_columns, out_rows);
    if (is_found && *out_columns < *out_rows) { /* a turned board is the same board */
        const int32_t columns = *out_rows;
        *out_rows = *out_columns;
        *out_columns = columns;
    }
    return is_found;
}
