/* How the face of a patch bends: a limb across itself, and hardly along it. */
#ifndef RLF_PHYSICS_GRID_BEND_H
#define RLF_PHYSICS_GRID_BEND_H

#include "physics/grid/patch.h"

/* Replaces the mean of a patch by the plane at the place that the ball touches, as far as the face
 * bends each way. */
void bend_correct(const grid_patch *p, patch_mean *mean);

#endif
