/* One corner's pixel error and its derivatives by everything that moves it. */
#ifndef RELIEF_APP_CALIBRATE_SIGHT_MODEL_H
#define RELIEF_APP_CALIBRATE_SIGHT_MODEL_H

#include "calibrate/solve.h"

typedef struct sight_term {
    double error[2];                    /* predicted minus seen, pixels */
    double shared[2][CALIBRATE_SHARED]; /* d error / d shared unknown */
    double own[2][6];                   /* d error / d rotation, translation of the board */
} sight_term;

/* Term of corner `index` of a camera's sight; where the board is behind the camera, the error is
 * large and the derivatives are 0. */
void sight_linearise(const calibrate_view *view, const calibrate_model *model, int32_t camera,
                     int32_t index, sight_term *out);

#endif
