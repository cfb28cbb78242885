/* Contacts where the camera does not look: the door to this folder. */
#ifndef RLF_PHYSICS_GRID_UNSEEN_UNSEEN_H
#define RLF_PHYSICS_GRID_UNSEEN_UNSEEN_H

#include "physics/grid/job.h"

/* Adds contacts with the room's planes and with upright faces, and brings scan.nearest2 down. */
void grid_unseen_collide(grid_job *job);

/* A way into view. */
typedef struct grid_shift {
    rlf_vec3 way;   /* grid frame, unit: up or down, or along the picture's rows */
    double length;  /* metres; 0: there is none */
    int32_t dx, dy; /* from the border's pixels inwards */
} grid_shift;

/* How a body about q (grid frame) must be moved until all of it is in view. There is no way where q
 * is in view, and not in a ring of missing pixels at the border, or nothing is in view close by. */
grid_shift grid_out_of_view(const grid_query *query, rlf_vec3 q, double radius);

/* Whether the touch of a body that was moved so is one with something that goes on to where the
 * picture ends. */
bool grid_goes_on(const grid_query *query, const grid_shift *shift, const grid_hit *hit);

#endif
