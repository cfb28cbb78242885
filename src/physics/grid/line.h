/* A line of the real surface beside a body: of a side wall, of a post. */
#ifndef RLF_PHYSICS_GRID_LINE_H
#define RLF_PHYSICS_GRID_LINE_H

#include "physics/grid/scan.h"

/* How far along `way` from `start` the line comes nearest to the body, whose distance is convex
 * along a line: 0 to `length`, in lengths of `way`; grid frame. */
double grid_line_nearest(const grid_job *job, rlf_vec3 start, rlf_vec3 way, double length);

#endif
