/* Left or right, by where the arm comes from. */
#ifndef RLF_HANDS_SIDE_H
#define RLF_HANDS_SIDE_H

#include "hands/gesture.h"

/* Sets `right` of all that are seen in one frame. */
void hand_sides_tell(hand_seen *seen, int32_t count, const hand_cells *c, const hand_limbs *l);

#endif
