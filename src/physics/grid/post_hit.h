/* Contacts with posts that the camera does not see. */
#ifndef RLF_PHYSICS_GRID_POST_HIT_H
#define RLF_PHYSICS_GRID_POST_HIT_H

#include "physics/grid/scan.h"

/* Adds to the job's hits, and brings nearest2 down. */
void grid_posts_collide(grid_job *job);

/* The least distance of a post from the body's centre, metres; no more than `wide`. */
double grid_posts_distance(const grid_job *job, double wide);

#endif
