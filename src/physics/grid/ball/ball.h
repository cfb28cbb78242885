/* A ball against a layer: the door to this folder.
 *
 * Every pixel says when the moving ball would reach it; the earliest of each direction is a touch.
 * About a touch the pixels give the plane that the ball meets, or the end of its face. */
#ifndef RLF_PHYSICS_GRID_BALL_BALL_H
#define RLF_PHYSICS_GRID_BALL_BALL_H

#include "physics/grid/job.h"

/* Cosine: a face is touched from its own side, up to noise. */
#define GRID_BALL_BEHIND (-0.2)

/* Seconds until the ball, `wider` than it is, reaches p, which moves with `velocity`; below 0 for a
 * point that is inside already, the deeper the less. False when that is not before the next query.
 */
bool grid_ball_time(const grid_job *job, rlf_vec3 p, rlf_vec3 velocity, double wider, double *out);

/* Whether the cell's back at p can push a ball in that direction: one that is a guess faces away
 * from the camera, for what faces it is seen. (Behind a side that is seen at a low angle the back
 * of the guess would stand in the solid's own front.) */
bool grid_ball_may_meet_back(const field_cell *cell, rlf_vec3 p, rlf_vec3 direction);

/* Notes the pixel, at p now, when the ball comes to its front or back before the next query. */
void grid_ball_look(grid_job *job, const field_cell *cell, rlf_vec3 p);

/* The same for the pixel of a flat tile that is nearest to the ball's way. */
void grid_ball_look_tile(grid_job *job, const grid_tile *tile);

/* The same for the side wall behind a contour's pixel, which goes inward by `deep`, metres of
 * thickness. */
void grid_ball_look_contour(grid_job *job, const field_cell *cell, rlf_vec3 shift, double deep);

/* Turns what was noted into hits. */
void grid_ball_add_hits(grid_job *job);

#endif
