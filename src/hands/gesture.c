/* What the fingers of one frame say. */
#include "hands/gesture.h"

#include <string.h>

#define TIPS_FOOTPRINT_M 0.0042 /* of a pixel: four lie across a finger */
#define FINGER_M 0.016          /* width of a finger */
#define OPEN_REACH 2.0          /* palm radii to the end of stretched fingers */
#define OPEN_TIPS 3
#define CLOSED_REACH 1.75    /* a fist's knuckles end before */
#define POINT_LONGER 1.35    /* a pointing index goes further than the thumb beside it */
#define FORWARD_COS 0.6      /* of the forearm with the way to the camera: 53 degrees */
#define FORWARD_SURE 0.8     /* of a hand whose forearm is hidden by it */
#define FORWARD 0.4f         /* of its length, that an arm towards the camera comes nearer */
#define PINCH_BEYOND_M 0.012 /* from the ring's edge to the middle of the fingers that close it */

static bool has_tips(const hand_patch *p, const hand_palm *palm)
{
    return palm->z / rlf_max(p->surface->camera.fx, 1.0) <= TIPS_FOOTPRINT_M;
}

/* Where the ring is closed: beyond its end that is furthest from the palm. */
static rlf_vec3 ring_end(const hand_patch *p, const hand_palm *palm)
{
    const double pixel = (double)p->spacing * palm->z;
    const double dx = p->ring.x - palm->x, dy = p->ring.y - palm->y;
    const double length = rlf_max(sqrt(dx * dx + dy * dy), 1e-6);
    const double more = (sqrt(p->ring.area / RLF_PI) + PINCH_BEYOND_M) / pixel;
    const double x = p->ring.x + dx / length * more, y = p->ring.y + dy / length * more;
    const int32_t at_x = (int32_t)rlf_clamp(x + 0.5, 0.0, p->width - 1.0);
    const int32_t at_y = (int32_t)rlf_clamp(y + 0.5, 0.0, p->height - 1.0);
    const int32_t at = at_y * p->width + at_x;
    const rlf_vec3 ahead = rlf_vec3_make(dx / length * more * pixel, dy / length * more * pixel, 0);
    const rlf_vec3 middle = rlf_vec3_make(dx * pixel, dy * pixel, 0);
    return p->disc[at] > 0 ? hand_patch_point(p, at)
                           : rlf_add(palm->centre, rlf_add(middle, ahead));
}

/* The narrowest gap between two fingers beside each other; fingers that meet at a ring have none.
 */
static void see_pinch(rlf_hand *h, const hand_patch *p, const hand_palm *palm)
{
    h->pinch_point = rlf_mad(palm->centre, h->direction, 2.0 * palm->radius);
    h->pinch_width = -1.0;
    for (int32_t k = 0; k + 1 < h->tip_count; k++) {
        const double apart = rlf_length(rlf_sub(h->tip[k], h->tip[k + 1])) - FINGER_M;
        if (h->pinch_width < 0.0 || apart < h->pinch_width) {
            h->pinch_width = rlf_max(apart, 0.0);
            h->pinch_point = rlf_scale(rlf_add(h->tip[k], h->tip[k + 1]), 0.5);
        }
    }
    if (p->ring.is_there && h->detail == RLF_HAND_TIPS) {
        h->pinch_width = 0.0;
        h->pinch_point = ring_end(p, palm);
    }
}

/* One finger, or a long one beside the thumb; its index goes first. */
static bool is_pointing(const hand_fingers *f, int32_t *out_finger)
{
    int32_t longest = 0;
    double second = 0.0;
    for (int32_t k = 1; k < f->tip_count; k++) {
        longest = f->tip_reach[k] > f->tip_reach[longest] ? k : longest;
    }
    for (int32_t k = 0; k < f->tip_count; k++) {
        second = k != longest ? rlf_max(second, f->tip_reach[k]) : second;
    }
    *out_finger = longest;
    return !f->has_wide_end && (f->tip_count == 1 || f->tip_count == 2) &&
           f->tip_reach[longest] > POINT_LONGER * second;
}

static rlf_gesture see_by_tips(const hand_fingers *f, const hand_patch *p, int32_t *out_finger)
{
    if (p->ring.is_there) {
        return RLF_GESTURE_PINCH;
    }
    if (f->tip_count >= OPEN_TIPS || (f->has_wide_end && f->reach > OPEN_REACH)) {
        return RLF_GESTURE_OPEN;
    }
    if (is_pointing(f, out_finger)) {
        return RLF_GESTURE_POINT;
    }
    return f->tip_count == 0 && f->reach < CLOSED_REACH ? RLF_GESTURE_FIST : RLF_GESTURE_NONE;
}

static rlf_gesture see_by_extent(const hand_fingers *f)
{
    if (f->reach > OPEN_REACH) {
        return RLF_GESTURE_OPEN;
    }
    return f->reach < CLOSED_REACH ? RLF_GESTURE_FIST : RLF_GESTURE_NONE;
}

void hand_gesture_see(hand_seen *out, const hand_patch *p, const hand_palm *palm,
                      const hand_fingers *f)
{
    rlf_hand *h = &out->hand;
    memset(h, 0, sizeof(*h));
    h->palm = palm->centre;
    h->normal = palm->normal;
    h->palm_radius = palm->radius;
    h->arm_direction = palm->arm;
    const rlf_vec3 flat = rlf_mad(f->direction, palm->normal, -rlf_dot(f->direction, palm->normal));
    h->direction = rlf_length(flat) > 1e-3 ? rlf_normalize(flat) : rlf_perpendicular(palm->normal);
    h->detail = has_tips(p, palm) ? RLF_HAND_TIPS : RLF_HAND_PALM_ONLY;
    if (h->detail == RLF_HAND_TIPS) {
        h->tip_count = f->tip_count;
        memcpy(h->tip, f->tip, sizeof(h->tip));
    }
    int32_t finger = 0;
    h->gesture = h->detail == RLF_HAND_TIPS ? see_by_tips(f, p, &finger) : see_by_extent(f);
    h->point_direction = h->direction;
    see_pinch(h, p, palm);
    if (h->gesture == RLF_GESTURE_POINT) {
        const rlf_vec3 index = h->tip[finger];
        h->tip[finger] = h->tip[0];
        h->tip[0] = index;
        h->point_direction = rlf_normalize(rlf_sub(index, palm->centre));
    }
}

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

double hand_confidence(const hand_limb *limb, const hand_palm *palm, const hand_fingers *f)
{
    /* Half a palm's breadth is 35 to 50 mm (5th to 95th percentile), edge-on 12; heads have 75. */
    double c = within(palm->radius, 0.010, 0.026, 0.047, 0.056);
    const bool is_foreshortened = is_forward(limb) || palm->arm.z < -FORWARD_COS;
    c *= is_foreshortened ? FORWARD_SURE : forearm_likeness(palm);
    c *= within((double)limb->length, 0.10, 0.18, 1.2, 1.4);
    c *= hangs_well(limb, palm);
    /* Nearly nothing but palm: a rod's end or a ball, no hand with a wrist. */
    c *= palm->has_wrist || f->reach > 1.2 ? 1.0 : 0.8;
    return c;
}
