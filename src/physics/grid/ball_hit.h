/* From a ball's touches to its contacts. */
#ifndef RLF_PHYSICS_GRID_BALL_HIT_H
#define RLF_PHYSICS_GRID_BALL_HIT_H

#include "physics/grid/scan.h"

/* Turns what was noted into hits. */
void grid_ball_add_hits(grid_job *job);

#endif
