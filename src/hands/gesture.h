/* One hand as one frame shows it. */
#ifndef RLF_HANDS_GESTURE_H
#define RLF_HANDS_GESTURE_H

#include "hands/fingers.h"

/* What a frame says before frames are compared. */
typedef struct hand_seen {
    rlf_hand hand; /* id, side, velocity and age are not known yet */
    int32_t limb;  /* index */
    double right;  /* > 0: by its arm it is a right hand, < 0 a left one; 0 = not known */
} hand_seen;

/* Puts palm, tips, gesture and pinch into out->hand. */
void hand_gesture_see(hand_seen *out, const hand_patch *p, const hand_palm *palm,
                      const hand_fingers *f);

/* 0..1 that such a palm at the end of such a limb is a hand. */
double hand_confidence(const hand_limb *limb, const hand_palm *palm, const hand_fingers *f);

#endif
