/* One hand as one frame shows it, and what its fitted fingers say. */
#ifndef RLF_HANDS_GESTURE_H
#define RLF_HANDS_GESTURE_H

#include "hands/palm.h"
#include "hands/search.h"
#include "relief/hands.h"

/* What a frame says before frames are compared. */
typedef struct hand_seen {
    rlf_hand hand;  /* id, side, velocity and age are not known yet */
    int32_t limb;   /* index */
    double right;   /* > 0: by its arm it is a right hand, < 0 a left one; 0 = not known */
    double no_foot; /* 0..1 */
} hand_seen;

/* What is known of it without a fit: palm, directions, detail. */
void hand_gesture_begin(rlf_hand *h, const hand_patch *p, const hand_palm *palm);

/* The same where only a fit of the frame before is known, whose palm has come to `palm`. */
void hand_gesture_go_on(rlf_hand *h, const hand_model *m, rlf_vec3 palm, double radius);

/* Palm, tips, gesture and pinch of a fit. */
void hand_gesture_read(rlf_hand *h, const hand_search *search, const hand_crop *crop);

/* ---- likeness.c: whether the end of a limb is a hand at all */

/* 0..1 that such a palm at the end of such a limb is a hand, before fingers are fitted. */
double hand_likeness_of_limb(const hand_limb *limb, const hand_palm *palm);

/* 0..1 that it is one, from that likeness of its limb, the energies of the best hand and of the
 * best thing that is none, and how much of it is seen, m^2. */
double hand_likeness_of_fit(double limb, double hand, double thing, double area);

/* Energy of the best thing that is none, as of hand_fit: a bent surface without gaps, which is a
 * plane, a ball, a cylinder or a cap, as may be. */
double hand_likeness_of_thing(const hand_crop *crop);

#endif
