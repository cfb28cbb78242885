/* What sticks out of the palm. */
#ifndef RLF_HANDS_FINGERS_H
#define RLF_HANDS_FINGERS_H

#include "hands/palm.h"
#include "relief/hands.h"

typedef struct hand_fingers {
    int32_t tip_count; /* ends as narrow as a finger */
    rlf_vec3 tip[RLF_HAND_TIPS_MAX];
    double tip_reach[RLF_HAND_TIPS_MAX]; /* from the palm's centre, metres */
    double reach;                        /* of the furthest pixel but the arm's, palm radii */
    double area;                         /* of the hand but the arm, palm discs */
    bool has_wide_end;  /* something wider than a finger sticks out: fingers held together */
    rlf_vec3 direction; /* from the palm to what sticks out; unit */
} hand_fingers;

void hand_fingers_find(hand_fingers *f, const hand_patch *p, const hand_palm *palm);

#endif
