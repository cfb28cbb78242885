/* What Relief needs of OpenCV, as C functions of a small shared library of its own,
 * librelief_opencv.so, which is opened at run time: OpenCV speaks C++ only, and a command that does
 * not calibrate need not load it. */
#ifndef RELIEF_APP_CALIBRATE_OPENCV_SHIM_H
#define RELIEF_APP_CALIBRATE_OPENCV_SHIM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RELIEF_OPENCV_VERSION 1
#define RELIEF_OPENCV_CORNERS_MAX 1024

/* A grey picture without padding between its rows. */
typedef struct relief_opencv_gray {
    const uint8_t *data;
    int32_t width, height;
} relief_opencv_gray;

/* A chessboard, or a ChArUco board of OpenCV's: a chessboard with markers in its white squares. */
typedef struct relief_opencv_board {
    int32_t columns, rows; /* of inner corners */
    double square, marker; /* side lengths, metres; marker only of ChArUco */
    int32_t is_charuco;
    int32_t dictionary; /* of the markers: OpenCV's number, 0 = DICT_4X4_50 */
    int32_t is_quick;   /* for video: give up at once where nothing looks like a board */
} relief_opencv_board;

/* Inner corners in a picture; corner id = row * columns + column. */
typedef struct relief_opencv_corners {
    int32_t count;
    int32_t id[RELIEF_OPENCV_CORNERS_MAX];
    double u[RELIEF_OPENCV_CORNERS_MAX], v[RELIEF_OPENCV_CORNERS_MAX]; /* pixels */
    double pitch; /* median distance to the nearest neighbour, pixels */
    double rise;  /* width of an edge from 10 to 90 % of its contrast, pixels; 0 = unknown */
} relief_opencv_corners;

/* Boards seen by one camera: view i has counts[i] points, one after the other. */
typedef struct relief_opencv_views {
    int32_t count;
    const int32_t *counts;
    const float *board; /* x y z of each point, metres */
    const float *pixel; /* u v of each point */
    int32_t width, height;
} relief_opencv_views;

/* Focal lengths, principal point, and k1 k2 p1 p2 k3. */
typedef struct relief_opencv_lens {
    double f[2], c[2], k[5];
} relief_opencv_lens;

/* F(result, name without relief_opencv_, parameters). Results: 1 = done, 0 = there is no such
 * thing, -1 = OpenCV gave up, error says why.
 * find: the board's corners. size: inner corners of a board that is larger than the one given.
 * calibrate: one camera; `poses` takes rotation vector and translation of each view, board to
 * camera. stereo: both cameras by the same points, from `lenses`; motion takes the rotation vector
 * and translation, first camera to second. */
#define RELIEF_OPENCV_FUNCTIONS(F)                                                                 \
    F(int, version, (void))                                                                        \
    F(const char *, error, (void))                                                                 \
    F(int, has_charuco, (void))                                                                    \
    F(int, find,                                                                                   \
      (const relief_opencv_gray *gray, const relief_opencv_board *board,                           \
       relief_opencv_corners *out))                                                                \
    F(int, size,                                                                                   \
      (const relief_opencv_gray *gray, const relief_opencv_board *board, int32_t *out_columns,     \
       int32_t *out_rows))                                                                         \
    F(int, calibrate,                                                                              \
      (const relief_opencv_views *views, relief_opencv_lens *out, double(*poses)[6],               \
       double *out_rms))                                                                           \
    F(int, stereo,                                                                                 \
      (const relief_opencv_views *first, const relief_opencv_views *second,                        \
       relief_opencv_lens lenses[2], double motion[6], double *out_rms))

#define RELIEF_OPENCV_DECLARE(result, name, parameters) result relief_opencv_##name parameters;
RELIEF_OPENCV_FUNCTIONS(RELIEF_OPENCV_DECLARE)
#undef RELIEF_OPENCV_DECLARE

typedef struct relief_opencv_api {
#define RELIEF_OPENCV_POINTER(result, name, parameters) result(*name) parameters;
    RELIEF_OPENCV_FUNCTIONS(RELIEF_OPENCV_POINTER)
#undef RELIEF_OPENCV_POINTER
} relief_opencv_api;

#ifdef __cplusplus
}
#endif
#endif
