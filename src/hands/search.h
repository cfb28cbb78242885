/* The pose of one hand over frames: several hopes side by side, and new ones where none fits. */
#ifndef RLF_HANDS_SEARCH_H
#define RLF_HANDS_SEARCH_H

#include "hands/fit.h"

#define SEARCH_HOPES 3
#define SEARCH_SURE 30.0 /* a fit of less energy is in the right basin in nine of ten frames */

typedef struct hand_hope {
    hand_fit fit;
    double energy; /* over frames */
    rlf_vec3 velocity;
} hand_hope;

typedef struct hand_search {
    hand_hope hope[SEARCH_HOPES]; /* the best first */
    int32_t count;
    int32_t next;   /* start to be tried */
    uint32_t frame; /* since it began */
    rlf_vec3 palm;  /* of its detector, in the frame before */
} hand_search;

/* What its detector says of a hand. */
typedef struct hand_sight {
    rlf_vec3 palm, normal, arm; /* as of hand_palm */
    double right;               /* > 0: by its arm a right hand, < 0: a left one */
} hand_sight;

void hand_search_begin(hand_search *h);

/* Where a hand that fitted well is looked for dt seconds later: a thing that it holds may have
 * taken its detector in. */
void hand_search_expect(const hand_search *h, hand_sight *sight, double dt);

/* One more frame, dt seconds after the last one; the first of `hope` is the pose. False: nothing
 * fits at all. */
bool hand_search_update(hand_search *h, const hand_crop *crop, const hand_sight *sight, double dt);

#endif
