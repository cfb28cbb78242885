/* Ends of limbs: the cells furthest along the foreground. */
#ifndef RLF_HANDS_LIMBS_H
#define RLF_HANDS_LIMBS_H

#include "hands/cells.h"

#define LIMBS_MAX 16      /* more than hands: feet, heads and chairs compete */
#define LIMB_PART_M 0.31f /* of its end that is looked at: a hand and a decimetre of forearm */

/* One end. */
typedef struct hand_limb {
    int32_t tip;            /* cell */
    hand_root root;         /* what it hangs on, */
    int32_t source;         /* and by which cell */
    float length;           /* from the root to the tip, metres */
    float rise;             /* how much nearer than its root the tip is, metres */
    int32_t x0, y0, x1, y1; /* cells of its end: x0 <= x < x1 */
} hand_limb;

/* Planes of one value per cell. */
typedef struct hand_limbs {
    hand_limb limb[LIMBS_MAX];
    int32_t count;
    uint8_t *owner;  /* 1 + index of the limb whose end has the cell; 0 = none */
    float *along;    /* of a cell with an owner: from that limb's tip, metres */
    float *from_tip; /* scratch, CELL_FAR between two calls */
} hand_limbs;

void hand_limbs_find(hand_limbs *l, hand_cells *c);

#endif
