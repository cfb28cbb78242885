/* Views of a calibration board by one or two cameras: what is known before anything is solved. */
#ifndef RELIEF_APP_CALIBRATE_VIEWS_H
#define RELIEF_APP_CALIBRATE_VIEWS_H

#include "relief/camera.h"

#define CALIBRATE_CAMERAS 2
#define CALIBRATE_VIEWS_MAX 128
#define CALIBRATE_NAME_SIZE 128

/* Lattice of inner corners of a chessboard; a ChArUco board has markers in its white squares. */
typedef struct calibrate_board {
    int32_t columns, rows; /* of inner corners */
    double square_m;
    bool is_charuco;
    double marker_m;     /* of ChArUco */
    int32_t dictionary;  /* of ChArUco: OpenCV's number */
    bool is_quick;       /* pictures of a video: many, and most without a board */
    double outline_m[2]; /* width and height of the whole board, its middle that of the lattice;
                            0 = unknown */
} calibrate_board;

/* A point of the board, metres in its plane, and the pixel where a camera sees it. */
typedef struct calibrate_point {
    double x, y, u, v;
} calibrate_point;

/* The board as one camera sees it. */
typedef struct calibrate_sight {
    calibrate_point *points; /* owned by the calibrate_views */
    int32_t count;           /* 0 = not seen */
    double sigma;            /* of the pixels, relative to that of other sights; > 0 */
} calibrate_sight;

typedef struct calibrate_view {
    char name[CALIBRATE_CAMERAS][CALIBRATE_NAME_SIZE]; /* "" = no picture */
    calibrate_sight sight[CALIBRATE_CAMERAS];
    bool is_used;
    char reason[160];       /* why it is not used */
    rlf_pose T_first_board; /* solved: board to the first camera */
    double offset_m;        /* depth offset on this board; NAN = not measured */
} calibrate_view;

typedef struct calibrate_views {
    calibrate_board board;
    calibrate_view *views;
    int32_t count, capacity;
    int32_t camera_count;
    int32_t width[CALIBRATE_CAMERAS], height[CALIBRATE_CAMERAS]; /* of the pictures */
    const char *camera_name[CALIBRATE_CAMERAS];                  /* for messages: "left" */
} calibrate_views;

rlf_result calibrate_views_create(const calibrate_board *board, calibrate_views *out);
void calibrate_views_destroy(calibrate_views *v);
/* A new view, used, without sights; NULL when there are CALIBRATE_VIEWS_MAX. */
calibrate_view *calibrate_views_add(calibrate_views *v);
/* Gives a view's camera room for `count` points. */
rlf_result calibrate_sight_resize(calibrate_sight *sight, int32_t count);
/* Point of the board's lattice, metres; the middle of the lattice is 0, 0. */
void calibrate_board_point(const calibrate_board *board, int32_t id, double *out_x, double *out_y);
/* Leaves a view out; the reason as printf. */
void calibrate_view_leave(calibrate_view *view, const char *format, ...) RLF_PRINTF(2, 3);
/* The name for messages: that of the first camera that has one. */
const char *calibrate_view_name(const calibrate_view *view);
/* Views that are used and that this camera (either of both: -1) sees. */
int32_t calibrate_views_used(const calibrate_views *v, int32_t camera);

#endif
