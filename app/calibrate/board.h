/* A chessboard to print, and what a printed board's file says of it. */
#ifndef RELIEF_APP_CALIBRATE_BOARD_H
#define RELIEF_APP_CALIBRATE_BOARD_H

#include "relief/base.h"

/* Inner corners and the side of a square. */
typedef struct board_size {
    int32_t columns, rows;
    double square_m; /* 0 = not said */
} board_size;

/* Writes a page with the board in its middle, a line about its size and a ruler of 100 mm: PDF, or
 * SVG where the path ends with .svg. On A4 or Letter, upright or across as it fits. */
rlf_result board_print(const char *path, const board_size *board, bool is_letter);
/* Finds what board_print wrote about the board. */
rlf_result board_read(const char *path, board_size *out);

#endif
