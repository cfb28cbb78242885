/* Picks views out of a video: where the board is still, and where it was not yet. */
#ifndef RELIEF_APP_CALIBRATE_PICKER_H
#define RELIEF_APP_CALIBRATE_PICKER_H

#include "calibrate/judge.h"
#include "calibrate/views.h"

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
