/* Whether the end of a limb is a hand at all. */
#ifndef RLF_HANDS_LIKENESS_H
#define RLF_HANDS_LIKENESS_H

#include "hands/palm.h"
#include "hands/search.h"

/* 0..1 that such a palm at the end of such a limb is a hand, before fingers are fitted. */
double hand_likeness_of_limb(const hand_limb *limb, const hand_palm *palm);

/* 0..1 that it is one, from that likeness of its limb, the energies of the best hand and of the
 * best thing that is none, and how much of it is seen, m^2. */
double hand_likeness_of_fit(double limb, double hand, double thing, double area);

/* Energy of the best thing that is none, as of hand_fit: a bent surface without gaps, which is a
 * plane, a ball, a cylinder or a cap, as may be. */
double hand_likeness_of_thing(const hand_crop *crop);

#endif
