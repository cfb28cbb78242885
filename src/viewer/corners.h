/* Where the window's corners go: keystone of a projector that stands askew. Knows no window, so
 * that tests can drive it. Not safe for two threads. */
#ifndef RLF_VIEWER_CORNERS_H
#define RLF_VIEWER_CORNERS_H

#include "relief/base.h"
#include "relief/math.h"

typedef struct viewer_corners {
    /* x and y of upper left, upper right, lower right, lower left: shares of the window's width and
     * height, from its upper left. */
    double at[8];
    rlf_mat3 map;     /* as rlf_gl_presenter_set_place takes it, while is_askew */
    bool is_askew;    /* else there is nothing to map */
    bool is_on;       /* they are being moved */
    bool is_held;     /* by the mouse */
    int32_t selected; /* 0 to 3 */
} viewer_corners;

/* Straight again. */
void viewer_corners_reset(viewer_corners *c);
/* False, and all as it was, when they make no picture: a dent, a line, turned over, or further
 * outside than the window is large. */
bool viewer_corners_set(viewer_corners *c, const double at[8]);
/* Selects the one nearest to a place, in shares. */
void viewer_corners_pick(viewer_corners *c, double x, double y);
/* Moves the selected one there, if that makes a picture. */
bool viewer_corners_move(viewer_corners *c, double x, double y);
/* The same by steps of a thousandth of the window. */
void viewer_corners_nudge(viewer_corners *c, double steps_x, double steps_y);
/* As they were saved; straight without a file, and with a warning for a bad one. path may be NULL.
 */
void viewer_corners_load(viewer_corners *c, const char *path);
/* RLF_ERROR_IO names the file. */
rlf_result viewer_corners_save(const viewer_corners *c, const char *path);

#endif
