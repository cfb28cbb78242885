/* Ids by the nearest predicted palm; the 1 Euro filter around a constant velocity. */
#include "hands/follow.h"

#include <string.h>

#define FORGET_NS INT64_C(300000000) /* a hand that is not seen for longer is a new one */
#define GAP_MAX_S 0.3                /* longer steps of time tell nothing of velocity */
#define GATE_M 0.12                  /* a palm may be so far from where it was expected, */
#define GATE_M_S 4.0                 /* and further by a hand's speed times the time */
#define VELOCITY_HZ 6.0              /* cut-off of the velocity */
#define TURN_SHARE 0.5               /* of a new direction, each frame */
#define FRAMES_TO_TELL 3             /* that agree on a gesture */
#define SURER 0.5                    /* of a higher confidence, each frame, */
#define LESS_SURE 0.1                /* and of a lower one: a hand may turn its edge */
#define MOVED_M 0.05                 /* what has not come so far since it was first seen */
#define UNMOVED 0.85                 /* is less sure: hands come into view by moving */
#define SIDE_LEAST 4.0               /* frames that tell one side more than the other */
#define SIDE_MOST 30.0

static double share_of(double hz, double dt)
{
    const double tau = 1.0 / (2.0 * RLF_PI * hz);
    return dt / (dt + tau);
}

static rlf_vec3 blend_direction(rlf_vec3 old, rlf_vec3 fresh, double share)
{
    const rlf_vec3 mixed = rlf_add(rlf_scale(old, 1.0 - share), rlf_scale(fresh, share));
    return rlf_length(mixed) > 0.2 ? rlf_normalize(mixed) : fresh;
}

/* The filter opens with speed, and what it keeps moves on as it did: no lag in straight motion. */
static void smooth(const hand_follow *f, rlf_hand *h, const rlf_hand *seen, double dt)
{
    const rlf_vec3 expected = rlf_mad(h->palm, h->velocity, dt);
    const rlf_vec3 off = rlf_sub(seen->palm, expected);
    const double speed = rlf_max(rlf_length(h->velocity), rlf_length(off) / dt);
    const double share = share_of(f->smooth_hz + f->smooth_opening * speed, dt);
    const rlf_vec3 palm = rlf_mad(expected, off, share);
    const rlf_vec3 measured = rlf_scale(rlf_sub(palm, h->palm), 1.0 / dt);
    h->velocity = rlf_mad(h->velocity, rlf_sub(measured, h->velocity), share_of(VELOCITY_HZ, dt));
    h->palm = palm;
    h->normal = blend_direction(h->normal, seen->normal, TURN_SHARE);
    h->arm_direction = blend_direction(h->arm_direction, seen->arm_direction, TURN_SHARE);
    const rlf_vec3 ahead = blend_direction(h->direction, seen->direction, TURN_SHARE);
    const rlf_vec3 flat = rlf_mad(ahead, h->normal, -rlf_dot(ahead, h->normal));
    h->direction = rlf_length(flat) > 0.1 ? rlf_normalize(flat) : rlf_perpendicular(h->normal);
    h->palm_radius += share_of(f->smooth_hz, dt) * (seen->palm_radius - h->palm_radius);
}

static void note_confidence(hand_track *t, double seen)
{
    t->has_moved = t->has_moved || rlf_length(rlf_sub(t->hand.palm, t->first_palm)) > MOVED_M;
    const double sure = t->has_moved ? seen : UNMOVED * seen;
    const double share = sure > t->hand.confidence ? SURER : LESS_SURE;
    t->hand.confidence += share * (sure - t->hand.confidence);
}

static void hold_gesture(hand_track *t, rlf_gesture seen)
{
    t->wishes = seen == t->wished ? t->wishes + 1 : 1;
    t->wished = seen;
    if (t->wishes >= FRAMES_TO_TELL) {
        t->hand.gesture = seen;
    }
}

/* A pinch begins and ends where it is held; of others the frame says. */
static void take_frame(hand_track *t, const rlf_hand *seen)
{
    rlf_hand *h = &t->hand;
    h->detail = seen->detail;
    h->tip_count = seen->tip_count;
    memcpy(h->tip, seen->tip, sizeof(h->tip));
    h->is_shape_sure = seen->is_shape_sure;
    h->facing = seen->facing;
    memcpy(h->shape, seen->shape, sizeof(h->shape));
    h->pinch_point = seen->pinch_point;
    h->pinch_width = seen->pinch_width;
    h->point_direction =
        h->gesture == RLF_GESTURE_POINT && seen->gesture == RLF_GESTURE_POINT
            ? blend_direction(h->point_direction, seen->point_direction, TURN_SHARE)
            : seen->point_direction;
}

static void note_side(hand_track *t, double right)
{
    t->right = rlf_clamp(t->right + right, -SIDE_MOST, SIDE_MOST);
    const bool is_known = t->right > SIDE_LEAST || t->right < -SIDE_LEAST;
    const rlf_hand_side side = t->right > 0.0 ? RLF_HAND_RIGHT : RLF_HAND_LEFT;
    t->hand.side = is_known ? side : t->hand.side;
}

static void see_again(const hand_follow *f, hand_track *t, const hand_seen *seen, rlf_hands *out)
{
    const double dt = (double)(out->time_ns - t->last_ns) * 1e-9;
    const rlf_gesture before = t->hand.gesture;
    if (dt > 0.0 && dt <= GAP_MAX_S) {
        smooth(f, &t->hand, &seen->hand, dt);
    }
    note_confidence(t, seen->hand.confidence);
    hold_gesture(t, seen->hand.gesture);
    take_frame(t, &seen->hand);
    note_side(t, seen->right);
    t->hand.age_ns = out->time_ns - t->first_ns;
    t->last_ns = out->time_ns;
    t->is_seen = true;
    t->limb = seen->limb;
    if (t->hand.confidence >= RLF_HAND_SURE) {
        hand_events_of_gesture(out, &t->hand, before);
        hand_events_of_motion(out, &t->hand, &t->motion);
    }
}

static void begin(hand_follow *f, hand_track *t, const hand_seen *seen, int64_t now_ns)
{
    memset(t, 0, sizeof(*t));
    t->hand = seen->hand;
    t->hand.id = ++f->next_id;
    t->hand.gesture = RLF_GESTURE_NONE;
    t->hand.confidence *= UNMOVED;
    t->first_palm = t->hand.palm;
    t->first_ns = t->last_ns = now_ns;
    t->is_seen = true;
    t->limb = seen->limb;
    hold_gesture(t, seen->hand.gesture);
    note_side(t, seen->right);
}

static double gate(const hand_track *t, double dt)
{
    return GATE_M + GATE_M_S * rlf_min(dt, GAP_MAX_S) * rlf_min(rlf_length(t->hand.velocity), 1.0);
}

/* The closest pair of a track and a hand that both have none yet; false when none is close. */
static bool closest(const hand_follow *f, const hand_seen *seen, const bool *is_taken,
                    int32_t count, int64_t now_ns, int32_t *out_track, int32_t *out_seen)
{
    double best = 1e9;
    for (int32_t k = 0; k < RLF_HANDS_MAX; k++) {
        const hand_track *t = &f->track[k];
        const double dt = (double)(now_ns - t->last_ns) * 1e-9;
        for (int32_t i = 0; i < count && t->hand.id > 0 && !t->is_seen; i++) {
            const rlf_vec3 expected =
                rlf_mad(t->hand.palm, t->hand.velocity, rlf_min(dt, GAP_MAX_S));
            const double d = rlf_length(rlf_sub(seen[i].hand.palm, expected));
            if (!is_taken[i] && d < gate(t, dt) && d < best) {
                best = d;
                *out_track = k;
                *out_seen = i;
            }
        }
    }
    return best < 1e9;
}

static void forget(hand_follow *f, rlf_hands *out)
{
    for (int32_t k = 0; k < RLF_HANDS_MAX; k++) {
        hand_track *t = &f->track[k];
        const bool is_over = out->time_ns - t->last_ns > FORGET_NS || out->time_ns < t->last_ns;
        if (t->hand.id > 0 && !t->is_seen && is_over) {
            const rlf_gesture before = t->hand.gesture;
            t->hand.gesture = RLF_GESTURE_NONE;
            if (t->hand.confidence >= RLF_HAND_SURE) {
                hand_events_of_gesture(out, &t->hand, before);
            }
            t->hand.id = 0;
        }
    }
}

/* The surest first, as long as there is room. */
static void begin_others(hand_follow *f, const hand_seen *seen, bool *is_taken, int32_t count,
                         int64_t now_ns)
{
    for (int32_t k = 0; k < RLF_HANDS_MAX; k++) {
        if (f->track[k].hand.id > 0) {
            continue;
        }
        int32_t best = -1;
        for (int32_t i = 0; i < count; i++) {
            if (!is_taken[i] &&
                (best < 0 || seen[i].hand.confidence > seen[best].hand.confidence)) {
                best = i;
            }
        }
        if (best < 0) {
            return;
        }
        is_taken[best] = true;
        begin(f, &f->track[k], &seen[best], now_ns);
    }
}

static void tell(const hand_follow *f, rlf_hands *out)
{
    out->count = 0;
    for (int32_t k = 0; k < RLF_HANDS_MAX; k++) {
        const hand_track *t = &f->track[k];
        if (t->hand.id > 0 && t->is_seen) {
            int32_t at = out->count++;
            for (; at > 0 && out->hand[at - 1].id > t->hand.id; at--) {
                out->hand[at] = out->hand[at - 1];
            }
            out->hand[at] = t->hand;
        }
    }
}

void hand_follow_update(hand_follow *f, hand_seen *seen, int32_t count, rlf_hands *out)
{
    bool is_taken[SEEN_MAX] = {false};
    int32_t track, i;
    out->event_count = 0;
    for (int32_t k = 0; k < RLF_HANDS_MAX; k++) {
        f->track[k].is_seen = false;
    }
    while (closest(f, seen, is_taken, count, out->time_ns, &track, &i)) {
        is_taken[i] = true;
        see_again(f, &f->track[track], &seen[i], out);
    }
    forget(f, out);
    begin_others(f, seen, is_taken, count, out->time_ns);
    tell(f, out);
}
