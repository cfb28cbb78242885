/* Left or right, by where the arm comes from. */
#ifndef RLF_HANDS_SIDE_H
#define RLF_HANDS_SIDE_H

#include "hands/limbs.h"

/* > 0: a right hand, < 0: a left one; 0 = not known. */
double hand_side_of(const hand_cells *c, const hand_limb *limb, rlf_vec3 arm);

#endif
