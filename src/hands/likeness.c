/* Limbs are told by their width, their length and what they hang on. */
#include "hands/gesture.h"

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

/* Nothing outside the outer two is a hand, all between the inner two may be; metres. Half a palm's
 * breadth is 35 to 50 mm (5th to 95th percentile), edge-on 12; heads have 75. A forearm, its sleeve
 * too, is 35 to 100 mm wide. From the middle of the body an arm is 0.6 to 0.9 m long and thinner
 * than a calf in trousers; a leg is 0.9 m and longer. */
static const double palm_radius[4] = {0.010, 0.026, 0.047, 0.056};
static const double limb_length[4] = {0.10, 0.18, 1.2, 1.4};
static const double forearm_half[4] = {0.012, 0.018, 0.050, 0.064};
static const double forearm_seen[2] = {0.03, 0.10};
static const double forearm_uneven[2] = {0.15, 0.30};
static const double arm_length[2] = {0.72, 0.85}, leg_length[2] = {0.95, 1.05};
static const double calf_half[2] = {0.040, 0.050};
static const double area_seen[2] = {0.0015, 0.0030}; /* m^2: a hand on its edge */

/* 0 at range[0] .. 1 at range[1]. */
static double beyond(double x, const double range[2])
{
    return rlf_clamp((x - range[0]) / (range[1] - range[0]), 0.0, 1.0);
}

static double within(double x, const double range[4])
{
    return rlf_min(beyond(x, range), 1.0 - beyond(x, range + 2));
}

static double leg_likeness(double length, double half)
{
    return rlf_max(beyond(length, arm_length) * beyond(half, calf_half),
                   beyond(length, leg_length));
}

/* An arm towards the camera: what is behind the hand is hidden by it, and no leg rises so. */
static bool is_forward(const hand_limb *limb)
{
    return limb->rise > FORWARD * limb->length;
}

static double hangs_well(const hand_limb *limb, const hand_palm *palm)
{
    static const double alone = 0.4, before = 0.65;
    switch (limb->root) {
    case HAND_ROOT_BORDER: return 1.0;
    case HAND_ROOT_BODY:
        return is_forward(limb) ? 1.0
                                : 1.0 - leg_likeness((double)limb->length, palm->forearm_half);
    case HAND_ROOT_FRONT: return is_forward(limb) ? 1.0 : before;
    case HAND_ROOT_ALONE:
    case HAND_ROOT_NONE: break;
    }
    return alone;
}

static double forearm_likeness(const hand_palm *palm)
{
    return (1.0 - beyond(palm->forearm_spread, forearm_uneven)) *
           beyond(palm->forearm, forearm_seen) * within(palm->forearm_half, forearm_half);
}

double hand_likeness_of_limb(const hand_limb *limb, const hand_palm *palm)
{
    const bool is_foreshortened = is_forward(limb) || palm->arm.z < -FORWARD_COS;
    /* Nearly nothing but palm: a rod's end or a ball, no hand with a wrist. */
    const double wrist = palm->has_wrist ? 1.0 : FORWARD_SURE;
    return within(palm->radius, palm_radius) * within((double)limb->length, limb_length) *
           (is_foreshortened ? FORWARD_SURE : forearm_likeness(palm)) * hangs_well(limb, palm) *
           wrist;
}

double hand_likeness_of_fit(double limb, double hand, double thing, double area)
{
    const double prior = rlf_clamp(limb, LIMB_LEAST, 1.0 - LIMB_LEAST);
    double odds = LIMB_SHARE * rlf_log_e(prior / (1.0 - prior));
    odds += THING_SHARE * rlf_log_e((thing + 1.0) / (hand + 1.0));
    odds -= rlf_clamp((hand - HAND_ENERGY) / HAND_WIDTH, 0.0, ODDS_MOST);
    return beyond(area, area_seen) / (1.0 + rlf_exp(-odds));
}
