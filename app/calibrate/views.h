/* Views of a calibration board by one or two cameras: where they come from, and what is known
 * before anything is solved. */
#ifndef RELIEF_APP_CALIBRATE_VIEWS_H
#define RELIEF_APP_CALIBRATE_VIEWS_H

#include "calibrate/opencv/opencv.h"
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

/* ---- picture_list.c: the pictures of a folder, and which of two folders' are of one moment */

#define CALIBRATE_PATH_SIZE 4096

typedef struct calibrate_pictures {
    char folder[CALIBRATE_PATH_SIZE];
    char (*names)[CALIBRATE_NAME_SIZE]; /* sorted by number, then by name */
    int32_t count;
} calibrate_pictures;

/* Names of the PNG and JPEG files of a folder, or of those that fit a pattern: "boards/left*".
 * RLF_ERROR_IO when there are none. */
rlf_result calibrate_pictures_list(const char *place, calibrate_pictures *out);
void calibrate_pictures_free(calibrate_pictures *p);
/* The whole path of picture `index`. */
void calibrate_pictures_path(const calibrate_pictures *p, const char *name,
                             char out[CALIBRATE_PATH_SIZE]);
/* The last number in a file's name; -1 = none. */
int64_t calibrate_picture_number(const char *name);

/* One moment: places in both lists, -1 = none. */
typedef struct calibrate_pair {
    int32_t index[CALIBRATE_CAMERAS];
} calibrate_pair;

/* Pairs by the number in the names; by order where numbers are missing or repeat and both have as
 * many. `pairs` has room for both lists; returns how many. -1 when they cannot be paired. */
int32_t calibrate_pictures_pair(const calibrate_pictures *a, const calibrate_pictures *b,
                                calibrate_pair *pairs);

/* ---- find.c: the board in one picture */

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

/* ---- picker.c: picks views out of a video: where the board is still, and where it was not yet */

typedef enum calibrate_side {
    CALIBRATE_LEFT = 0, /* of the board is nearer */
    CALIBRATE_RIGHT = 1,
    CALIBRATE_TOP = 2,
    CALIBRATE_BOTTOM = 3
} calibrate_side;
#define CALIBRATE_SIDES 4

typedef struct calibrate_picker {
    calibrate_sight last;        /* the board in the picture before; count 0 = none */
    int32_t still;               /* pictures in a row in which it has not moved */
    bool tilts[CALIBRATE_SIDES]; /* sides that were nearer in some view */
} calibrate_picker;

typedef enum calibrate_pick {
    CALIBRATE_PICK_NONE = 0,   /* no board */
    CALIBRATE_PICK_MOVING = 1, /* it moves, or has only just stopped */
    CALIBRATE_PICK_KNOWN = 2,  /* as in a view before */
    CALIBRATE_PICK_TAKE = 3
} calibrate_pick;

void calibrate_picker_destroy(calibrate_picker *p);
/* What to do with the board in the next picture of the second camera (width pixels wide). */
calibrate_pick calibrate_picker_next(calibrate_picker *p, const calibrate_views *views,
                                     const calibrate_sight *sight);
/* Counts a view that was taken. */
void calibrate_picker_took(calibrate_picker *p, const calibrate_views *views,
                           const calibrate_sight *sight);
/* What is still asked for, in words; false when nothing is. */
bool calibrate_picker_wish(const calibrate_picker *p, const calibrate_views *views, char *out,
                           size_t size);

#endif
