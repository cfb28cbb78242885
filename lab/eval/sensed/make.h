/* Random things to throw, and where to. */
#ifndef RELIEF_APP_EVAL_SENSED_MAKE_H
#define RELIEF_APP_EVAL_SENSED_MAKE_H

#include "eval/analytic.h"
#include "eval/sensed/room.h"
#include "eval/sensed/throw.h"

/* A body of any shape (or a ball), 2 to 20 cm in radius, thrown in the stage's present frame. False
 * when there is nothing to aim at or no free place to throw from. */
bool eval_sensed_make(const eval_throw_def *def, const eval_room *stage, eval_random *r,
                      rlf_body_def *out);

/* Radius of the largest ball about the centre that the shape holds. */
double eval_inner_radius(const rlf_shape *shape);

#endif
