/* The board in one picture. */
#ifndef RELIEF_APP_CALIBRATE_FIND_H
#define RELIEF_APP_CALIBRATE_FIND_H

#include "calibrate/opencv/opencv.h"
#include "calibrate/views.h"

/* A grey picture; rlf_free its data. */
typedef struct calibrate_gray {
    uint8_t *data;
    int32_t width, height;
} calibrate_gray;

/* Reads a picture as grey. 16-bit grey ones, as of infrared cameras, are stretched to their
 * brightest 1 in 200. */
rlf_result calibrate_gray_read(const char *path, calibrate_gray *out);
/* Of an RGBA picture, ITU-R BT.601. */
rlf_result calibrate_gray_from_rgba(const rlf_image_rgba8 *image, calibrate_gray *out);

typedef enum calibrate_found {
    CALIBRATE_FOUND = 0,
    CALIBRATE_ABSENT = 1,  /* no board, or not all of it */
    CALIBRATE_BLURRED = 2, /* edges as wide as half a square: the corners are not where they seem */
    CALIBRATE_FAILED = 3   /* the error line says why */
} calibrate_found;

/* Looks for the board; FOUND fills `sight`. */
calibrate_found calibrate_find(const relief_opencv_api *api, const calibrate_gray *gray,
                               const calibrate_board *board, calibrate_sight *sight);
/* A larger board in the picture than the one looked for: its inner corners. */
bool calibrate_find_larger(const relief_opencv_api *api, const calibrate_gray *gray,
                           const calibrate_board *board, int32_t *out_columns, int32_t *out_rows);
/* Another size that the board may have; false when nothing like a chessboard is there. */
bool calibrate_find_other(const relief_opencv_api *api, const calibrate_gray *gray,
                          const calibrate_board *board, int32_t *out_columns, int32_t *out_rows);

#endif
