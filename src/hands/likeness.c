/* Limbs are told by their width, their length and what they hang on. */
#include "hands/likeness.h"

#define FORWARD_COS 0.6  /* of the forearm with the way to the camera: 53 degrees */
#define FORWARD_SURE 0.8 /* of a hand whose forearm is hidden by it */
#define FORWARD 0.4f     /* of its length, that an arm towards the camera comes nearer */

/* Odds by energies: of a hand against a thing; a fit that is good by itself proves nothing. */
#define LIMB_LEAST 0.1
#define LIMB_SHARE 0.4
#define THING_SHARE 1.5
#define HAND_ENERGY 35.0
#define HAND_WIDTH 25.0
#define ODDS_MOST 1.5

/* 1 between b and c, 0 outside a and d, straight lines between. */
static double within(double x, double a, double b, double c, double d)
{
    return rlf_clamp(rlf_min((x - a) / (b - a), (d - x) / (d - c)), 0.0, 1.0);
}

/* From the middle of the body an arm is 0.6 to 0.9 m long and thinner than a calf in trousers; a
 * leg is 0.9 m and longer. */
static double leg_likeness(const hand_limb *limb, double half)
{
    const double is_long = rlf_clamp(((double)limb->length - 0.72) / 0.13, 0.0, 1.0);
    const double is_thick = rlf_clamp((half - 0.040) / 0.010, 0.0, 1.0);
    const double is_longer = rlf_clamp(((double)limb->length - 0.95) / 0.10, 0.0, 1.0);
    return rlf_max(is_long * is_thick, is_longer);
}

/* An arm towards the camera: what is behind the hand is hidden by it, and no leg rises so. */
static bool is_forward(const hand_limb *limb)
{
    return limb->rise > FORWARD * limb->length;
}

static double hangs_well(const hand_limb *limb, const hand_palm *palm)
{
    switch (limb->root) {
    case HAND_ROOT_BORDER: return 1.0;
    case HAND_ROOT_BODY:
        return is_forward(limb) ? 1.0 : 1.0 - leg_likeness(limb, palm->forearm_half);
    case HAND_ROOT_FRONT: return is_forward(limb) ? 1.0 : 0.65;
    case HAND_ROOT_ALONE:
    case HAND_ROOT_NONE: break;
    }
    return 0.4;
}

/* A forearm, its sleeve too, is 35 to 100 mm wide, and at least a decimetre of it is seen. */
static double forearm_likeness(const hand_palm *palm)
{
    const double is_even = rlf_clamp((0.30 - palm->forearm_spread) / 0.15, 0.0, 1.0);
    const double is_long = rlf_clamp((palm->forearm - 0.03) / 0.07, 0.0, 1.0);
    return is_even * is_long * within(palm->forearm_half, 0.012, 0.018, 0.050, 0.064);
}

double hand_likeness_of_limb(const hand_limb *limb, const hand_palm *palm)
{
    /* Half a palm's breadth is 35 to 50 mm (5th to 95th percentile), edge-on 12; heads have 75. */
    double c = within(palm->radius, 0.010, 0.026, 0.047, 0.056);
    const bool is_foreshortened = is_forward(limb) || palm->arm.z < -FORWARD_COS;
    c *= is_foreshortened ? FORWARD_SURE : forearm_likeness(palm);
    c *= within((double)limb->length, 0.10, 0.18, 1.2, 1.4);
    c *= hangs_well(limb, palm);
    /* Nearly nothing but palm: a rod's end or a ball, no hand with a wrist. */
    c *= palm->has_wrist ? 1.0 : 0.8;
    return c;
}

double hand_likeness_of_fit(double limb, double hand, double thing)
{
    const double prior = rlf_clamp(limb, LIMB_LEAST, 1.0 - LIMB_LEAST);
    double odds = LIMB_SHARE * rlf_log_e(prior / (1.0 - prior));
    odds += THING_SHARE * rlf_log_e((thing + 1.0) / (hand + 1.0));
    odds -= rlf_clamp((hand - HAND_ENERGY) / HAND_WIDTH, 0.0, ODDS_MOST);
    return 1.0 / (1.0 + rlf_exp(-odds));
}
