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

#endif
