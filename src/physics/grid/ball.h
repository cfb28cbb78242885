/* A ball against a sheet: which point it touches first, and in which direction. */
#ifndef RLF_PHYSICS_GRID_BALL_H
#define RLF_PHYSICS_GRID_BALL_H

#include "physics/grid/scan.h"

/* Notes the pixel, at p now, when the ball comes to its front or back before the next query. */
void grid_ball_look(grid_job *job, const field_cell *cell, rlf_vec3 p);

/* The same for the pixel of a flat tile that is nearest to the ball's way. */
void grid_ball_look_tile(grid_job *job, const grid_tile *tile);

/* The same for the side wall behind an outline's pixel, which goes inward by `deep`, metres of
 * thickness. */
void grid_ball_look_outline(grid_job *job, const field_cell *cell, rlf_vec3 shift, double deep);

/* Turns what was noted into hits. */
void grid_ball_add_hits(grid_job *job);

#endif
