/* Gestures by how far each finger reaches along the palm, and by the gap between thumb and index.
 */
#include "hands/gesture.h"

#include <string.h>

#define TIPS_FOOTPRINT_M 0.0042 /* of a pixel: four lie across a finger */
/* Reach of a finger along the palm, of its length: stretched it is 1, bent by 60 degrees in each
 * joint 0.2, in a fist less than 0. */
#define OPEN_REACH 0.8
#define POINT_REACH 0.8
#define POINT_MORE 0.3 /* than the others; hidden ones are taken to be half bent */
#define BENT_REACH 0.5
#define FIST_REACH 0.45
#define PINCH_REACH 0.35 /* of the others: in a fist the thumb meets the index, too */
#define PINCH_M 0.014    /* skin to skin: as far as the fit is off */
/* Far away, in palm radii: the ends of stretched fingers, and a fist's knuckles. */
#define FAR_OPEN 2.0
#define FAR_FIST 1.75
#define FARTHEST 3        /* pixels: fewer are noise */
#define ARM_COS (-0.5)    /* directions this close to the arm's are the arm: 60 degrees */
#define TIP_REACH 0.6     /* of a finger that sticks out */
#define TIP_SEEN_M 0.02   /* what is seen at a tip is no farther before or behind it */
#define THUMB_OFF_M 0.035 /* a thumb beside the palm does not stick out */
#define PALM_M 0.015      /* middle of a palm's disc from that of its bones */
#define READ_MOST 90.0    /* energy of a fit beyond which it says nothing */

static bool has_tips(const hand_patch *p, const hand_palm *palm)
{
    return palm->z / rlf_max(p->surface->camera.fx, 1.0) <= TIPS_FOOTPRINT_M;
}

void hand_gesture_begin(rlf_hand *h, const hand_patch *p, const hand_palm *palm)
{
    memset(h, 0, sizeof(*h));
    h->palm = palm->centre;
    h->normal = palm->normal;
    h->palm_radius = palm->radius;
    h->arm_direction = palm->arm;
    const rlf_vec3 flat = rlf_mad(palm->arm, palm->normal, -rlf_dot(palm->arm, palm->normal));
    h->direction = rlf_length(flat) > 1e-3 ? rlf_normalize(flat) : rlf_perpendicular(palm->normal);
    h->detail = has_tips(p, palm) ? RLF_HAND_TIPS : RLF_HAND_PALM_ONLY;
    h->point_direction = h->direction;
    h->pinch_point = rlf_mad(palm->centre, h->direction, 2.0 * palm->radius);
    h->pinch_width = -1.0;
}

void hand_gesture_go_on(rlf_hand *h, const hand_model *m, rlf_vec3 palm, double radius)
{
    const rlf_vec3 towards = rlf_normalize(rlf_neg(palm));
    memset(h, 0, sizeof(*h));
    h->palm = rlf_mad(palm, towards, m->radius_b[0]);
    h->normal = rlf_dot(m->z, palm) < 0.0 ? m->z : rlf_neg(m->z);
    h->palm_radius = radius;
    h->arm_direction = rlf_normalize(rlf_sub(m->a[MODEL_HAND], m->b[MODEL_CONES - 1]));
    h->direction = h->point_direction = m->y;
    h->detail = RLF_HAND_TIPS;
    h->pinch_point = rlf_mad(h->palm, h->direction, 2.0 * radius);
    h->pinch_width = -1.0;
}

static double tip_radius(const hand_model *m, int32_t digit)
{
    return m->radius_b[MODEL_PALM + 3 * digit + 2];
}

/* Of the skin, between its end and its side towards the camera. */
static rlf_vec3 seen_tip(const hand_model *m, int32_t digit)
{
    const rlf_vec3 end = m->joint[digit][3];
    const rlf_vec3 along = rlf_normalize(rlf_sub(end, m->joint[digit][2]));
    const rlf_vec3 side = rlf_sub(along, rlf_normalize(end));
    const double length = rlf_length(side);
    return length > 1e-3 ? rlf_mad(end, side, tip_radius(m, digit) / length) : end;
}

/* Whether the camera sees the hand where the tip is. */
static bool is_seen(const hand_crop *c, rlf_vec3 tip)
{
    const double x = c->fx * tip.x / tip.z + c->cx, y = c->fy * tip.y / tip.z + c->cy;
    if (!(tip.z > 0.0 && x >= 0.0 && y >= 0.0 && x < c->width - 0.5 && y < c->height - 0.5)) {
        return false;
    }
    const int32_t i = (int32_t)(y + 0.5) * c->width + (int32_t)(x + 0.5);
    const int32_t at = c->nearest[i];
    if (at < 0) {
        return false;
    }
    const double dx = at % c->width - x, dy = (double)(at / c->width) - y;
    const double beside = sqrt(dx * dx + dy * dy) * tip.z / c->fx;
    const double deep = (double)c->z[at] - tip.z;
    return beside < TIP_SEEN_M && deep < TIP_SEEN_M && deep > -TIP_SEEN_M;
}

static rlf_gesture gesture_of(const double reach[5], double gap)
{
    const double others = (reach[2] + reach[3] + reach[4]) / 3.0;
    const double mean = 0.25 * reach[1] + 0.75 * others;
    if (gap < PINCH_M && (others > PINCH_REACH || reach[1] > others + POINT_MORE)) {
        return RLF_GESTURE_PINCH;
    }
    if (reach[1] > POINT_REACH && others < reach[1] - POINT_MORE) {
        return RLF_GESTURE_POINT;
    }
    if (mean > OPEN_REACH) {
        return RLF_GESTURE_OPEN;
    }
    return mean < FIST_REACH && reach[1] < BENT_REACH ? RLF_GESTURE_FIST : RLF_GESTURE_NONE;
}

/* Open and closed alone, by how far the hand's pixels reach from its palm, but the arm's. */
static rlf_gesture coarse_gesture(const rlf_hand *h, const hand_crop *c)
{
    double far[FARTHEST] = {0.0};
    for (int32_t i = 0; i < c->count; i++) {
        const rlf_vec3 p = {(double)c->x[i], (double)c->y[i], (double)c->p_z[i]};
        const rlf_vec3 off = rlf_sub(p, h->palm);
        const double flat = sqrt(off.x * off.x + off.y * off.y); /* depth trembles */
        if (rlf_dot(off, h->arm_direction) < ARM_COS * flat) {
            continue;
        }
        double next = flat;
        for (int32_t k = 0; k < FARTHEST; k++) {
            const double more = rlf_max(far[k], next);
            next = rlf_min(far[k], next);
            far[k] = more;
        }
    }
    const double reach = far[FARTHEST - 1] / rlf_max(h->palm_radius, 0.01);
    return reach > FAR_OPEN ? RLF_GESTURE_OPEN
                            : (reach < FAR_FIST ? RLF_GESTURE_FIST : RLF_GESTURE_NONE);
}

static void read_tips(rlf_hand *h, const hand_model *m, const hand_crop *crop,
                      const double reach[5])
{
    const int32_t first = h->gesture == RLF_GESTURE_POINT ? 1 : 0;
    for (int32_t k = 0; k < 5; k++) {
        const int32_t digit = first == 0 ? k : (k == 0 ? 1 : (k == 1 ? 0 : k));
        const rlf_vec3 tip = seen_tip(m, digit), off = rlf_sub(m->joint[digit][3], m->palm);
        const double aside = rlf_length(rlf_mad(off, m->y, -rlf_dot(off, m->y)));
        const bool is_out = digit == 0 ? aside > THUMB_OFF_M : reach[digit] > TIP_REACH;
        if (is_out && is_seen(crop, tip)) {
            h->tip[h->tip_count++] = tip;
        }
    }
}

/* The disc's middle, which trembles less, but no farther from the fit's than palms differ. */
static rlf_vec3 middle_of_palm(const rlf_hand *h, rlf_vec3 fit)
{
    const rlf_vec3 off = rlf_sub(h->palm, fit);
    const double far = rlf_length(off);
    return far > PALM_M ? rlf_mad(fit, off, PALM_M / far) : h->palm;
}

void hand_gesture_read(rlf_hand *h, const hand_search *search, const hand_crop *crop)
{
    const hand_hope *best = &search->hope[0];
    hand_model m;
    double reach[5];
    if (h->detail == RLF_HAND_PALM_ONLY) {
        h->gesture = coarse_gesture(h, crop);
        return;
    }
    hand_model_build(&m, &best->fit.pose);
    for (int32_t digit = 0; digit < 5; digit++) {
        reach[digit] = hand_model_stretch(&m, digit);
    }
    if (best->energy > READ_MOST) {
        return;
    }
    const rlf_vec3 thumb = m.joint[0][3], index = m.joint[1][3];
    const double gap =
        rlf_max(rlf_length(rlf_sub(thumb, index)) - tip_radius(&m, 0) - tip_radius(&m, 1), 0.0);
    h->gesture = gesture_of(reach, gap);
    h->is_shape_sure = best->energy < SEARCH_SURE;
    h->facing = rlf_neg(m.z);
    for (int32_t k = 0; k < RLF_HAND_CONES; k++) {
        h->shape[k] = (rlf_round_cone){m.a[k], m.b[k], m.radius_a[k], m.radius_b[k]};
    }
    const double towards = rlf_dot(m.z, m.palm) < 0.0 ? 1.0 : -1.0;
    h->normal = rlf_scale(m.z, towards);
    h->palm = middle_of_palm(h, rlf_mad(m.palm, h->normal, m.radius_b[0]));
    h->direction = m.y;
    h->pinch_point = rlf_scale(rlf_add(thumb, index), 0.5);
    h->pinch_width = h->gesture == RLF_GESTURE_PINCH ? 0.0 : gap;
    read_tips(h, &m, crop, reach);
    h->point_direction = h->gesture == RLF_GESTURE_POINT
                             ? rlf_normalize(rlf_sub(index, m.joint[1][0]))
                             : h->direction;
}
