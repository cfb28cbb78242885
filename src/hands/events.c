/* What begins and ends, and motions that mean something. */
#include "hands/follow.h"

#include <string.h>

#define WINDOW_NS INT64_C(450000000)  /* a stroke is made within this time */
#define SILENCE_NS INT64_C(700000000) /* after one: the hand goes back */
#define SWIPE_M 0.22
#define PUSH_M 0.15
#define STROKE_SLANT 0.5            /* most motion across a stroke, of its length */
#define STROKE_M_S 0.5              /* mean speed of a stroke */
#define WAVE_M 0.05                 /* least way between two turns */
#define WAVE_NS INT64_C(2000000000) /* all turns of a wave */
#define TURN_NS INT64_C(500000000)  /* a stroke right after a turn is a wave's */

void hand_event_add(rlf_hands *out, const rlf_hand *hand, rlf_hand_event_kind kind)
{
    if (out->event_count >= RLF_HAND_EVENTS_MAX) {
        return;
    }
    rlf_hand_event *e = &out->event[out->event_count++];
    *e = (rlf_hand_event){kind, hand->id, hand->palm, hand->direction, hand->velocity};
    if (kind == RLF_HAND_EVENT_PINCH_BEGIN || kind == RLF_HAND_EVENT_PINCH_END) {
        e->position = hand->pinch_point;
    } else if (kind == RLF_HAND_EVENT_POINT_BEGIN && hand->tip_count > 0) {
        e->position = hand->tip[0];
        e->direction = hand->point_direction;
    }
}

void hand_events_of_gesture(rlf_hands *out, const rlf_hand *hand, rlf_gesture before)
{
    if (hand->gesture == before) {
        return;
    }
    if (before == RLF_GESTURE_PINCH) {
        hand_event_add(out, hand, RLF_HAND_EVENT_PINCH_END);
    } else if (before == RLF_GESTURE_POINT) {
        hand_event_add(out, hand, RLF_HAND_EVENT_POINT_END);
    }
    switch (hand->gesture) {
    case RLF_GESTURE_PINCH: hand_event_add(out, hand, RLF_HAND_EVENT_PINCH_BEGIN); break;
    case RLF_GESTURE_OPEN: hand_event_add(out, hand, RLF_HAND_EVENT_OPEN); break;
    case RLF_GESTURE_FIST: hand_event_add(out, hand, RLF_HAND_EVENT_FIST); break;
    case RLF_GESTURE_POINT: hand_event_add(out, hand, RLF_HAND_EVENT_POINT_BEGIN); break;
    case RLF_GESTURE_NONE: break;
    }
}

static void remember(hand_motion *m, int64_t time_ns, rlf_vec3 palm)
{
    if (m->count == HAND_HISTORY) {
        m->count--;
        memmove(m->past, m->past + 1, sizeof(m->past) - sizeof(m->past[0]));
    }
    m->past[m->count++] = (hand_moment){time_ns, palm};
}

/* A turn counts when the hand has come back by WAVE_M. */
static bool note_turn(hand_motion *m, double x, int64_t now_ns)
{
    const double back = m->sense >= 0 ? m->extreme - x : x - m->extreme;
    if (m->sense == 0) {
        m->extreme = x;
        m->sense = 1;
    } else if (back < 0.0) {
        m->extreme = x;
    } else if (back > WAVE_M) {
        m->sense = -m->sense;
        m->extreme = x;
        memmove(m->turn_ns, m->turn_ns + 1, sizeof(m->turn_ns) - sizeof(m->turn_ns[0]));
        m->turn_ns[HAND_TURNS - 1] = now_ns;
        return m->turn_ns[0] > 0 && now_ns - m->turn_ns[0] < WAVE_NS;
    }
    return false;
}

/* A straight way of at least `length` along `axis` that ends now; its sense, or 0. */
static int32_t stroke(const hand_motion *m, rlf_vec3 axis, double length)
{
    const hand_moment *now = &m->past[m->count - 1];
    for (int32_t k = m->count - 2; k >= 0; k--) {
        const int64_t age_ns = now->time_ns - m->past[k].time_ns;
        if (age_ns > WINDOW_NS) {
            return 0;
        }
        const rlf_vec3 way = rlf_sub(now->palm, m->past[k].palm);
        const double along = rlf_dot(way, axis);
        const double size = along < 0.0 ? -along : along;
        const double across = rlf_length(rlf_mad(way, axis, -along));
        if (size >= length && across < STROKE_SLANT * size &&
            size > STROKE_M_S * (double)age_ns * 1e-9) {
            return along > 0.0 ? 1 : -1;
        }
    }
    return 0;
}

void hand_events_of_motion(rlf_hands *out, const rlf_hand *hand, hand_motion *m)
{
    const int64_t now_ns = out->time_ns;
    const rlf_vec3 right = {1, 0, 0};
    remember(m, now_ns, hand->palm);
    const int64_t before_ns = m->turn_ns[HAND_TURNS - 1];
    const bool has_turned = before_ns > 0 && now_ns - before_ns < TURN_NS;
    if (note_turn(m, hand->palm.x, now_ns)) {
        hand_event_add(out, hand, RLF_HAND_EVENT_WAVE);
        memset(m->turn_ns, 0, sizeof(m->turn_ns));
        m->silent_until_ns = now_ns + SILENCE_NS;
    }
    if (now_ns < m->silent_until_ns || has_turned) {
        return;
    }
    const int32_t swipe = stroke(m, right, SWIPE_M);
    const int32_t push = swipe == 0 ? stroke(m, hand->arm_direction, PUSH_M) : 0;
    const bool has_stopped = rlf_dot(hand->velocity, hand->arm_direction) < STROKE_M_S;
    if (swipe != 0) {
        hand_event_add(out, hand,
                       swipe > 0 ? RLF_HAND_EVENT_SWIPE_RIGHT : RLF_HAND_EVENT_SWIPE_LEFT);
        m->silent_until_ns = now_ns + SILENCE_NS;
    } else if (push > 0 && has_stopped) {
        hand_event_add(out, hand, RLF_HAND_EVENT_PUSH);
        m->silent_until_ns = now_ns + SILENCE_NS;
    }
}
