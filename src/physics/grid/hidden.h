/* Contacts with what the camera does not see and what is known to be there: the room's shell, what
 * stands behind what hides it, and level faces behind what stands on them. */
#ifndef RLF_PHYSICS_GRID_HIDDEN_H
#define RLF_PHYSICS_GRID_HIDDEN_H

#include "physics/grid/scan.h"

/* Adds to the job's hits, and brings nearest2 down; what is within `wide` of the body's centre is
 * looked for. */
void grid_hidden_collide(grid_job *job, double wide);

/* The centre's least height over the shell's planes, metres; no more than `wide`. */
double grid_hidden_shell_height(const grid_job *job, double wide);

/* The same over the other faces, which are dearer to find. */
double grid_hidden_face_height(const grid_job *job, double wide);

#endif
