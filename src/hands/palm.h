/* The palm: the largest disc in a limb's end beyond the wrist. */
#ifndef RLF_HANDS_PALM_H
#define RLF_HANDS_PALM_H

#include "hands/limbs.h"

typedef struct hand_palm {
    double x, y;           /* its centre, patch pixels */
    double z;              /* there, metres */
    double along;          /* from the limb's tip to there, metres */
    double radius;         /* metres */
    rlf_vec3 centre;       /* metres */
    rlf_vec3 normal;       /* unit, towards the camera */
    rlf_vec3 arm;          /* unit, from the forearm to the palm */
    bool has_wrist;        /* the limb is narrower behind the palm */
    double forearm;        /* how much of it is seen behind the wrist, metres */
    double forearm_half;   /* its half width, metres; 0 = not seen */
    double forearm_spread; /* standard deviation of that from a straight taper, of its mean */
} hand_palm;

/* False: there is no disc that could be a palm. */
bool hand_palm_find(hand_palm *palm, const hand_patch *p);

#endif
