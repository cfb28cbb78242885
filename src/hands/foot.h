/* Feet stand under a body; hands do not. */
#ifndef RLF_HANDS_FOOT_H
#define RLF_HANDS_FOOT_H

#include "hands/cells.h"

/* 0..1 that a limb that ends at `point` stands on a foot there: it is at the lower end of what is
 * seen in its place, and a body goes on high above. `down` is gravity's direction in the camera's
 * frame, unit; 0 = not known, and then nothing is a foot. */
double hand_foot_likeness(const hand_cells *c, rlf_vec3 point, rlf_vec3 down);

#endif
