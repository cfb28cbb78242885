/* The same hands from frame to frame: ids, smoothing, gestures held against flicker, events. */
#ifndef RLF_HANDS_FOLLOW_H
#define RLF_HANDS_FOLLOW_H

#include "hands/gesture.h"

#define FITS_MAX 4                      /* hands whose fingers are fitted: the likeliest */
#define SEEN_MAX (LIMBS_MAX + FITS_MAX) /* ends of limbs, and fits that go on without */
#define HAND_HISTORY 32                 /* frames of one hand: a second */
#define HAND_TURNS 4                    /* of a hand that waves */

/* Where a hand was. */
typedef struct hand_moment {
    int64_t time_ns;
    rlf_vec3 palm;
} hand_moment;

/* What its motion has been, for events. */
typedef struct hand_motion {
    hand_moment past[HAND_HISTORY];
    int32_t count;               /* of the moments, the newest last */
    int64_t silent_until_ns;     /* no swipe and no push before */
    double extreme;              /* of x since the last turn */
    int32_t sense;               /* 1 to the right, -1 to the left, 0 = not yet */
    int64_t turn_ns[HAND_TURNS]; /* the newest last; 0 = none */
} hand_motion;

/* One hand that is followed. */
typedef struct hand_track {
    rlf_hand hand; /* as last told */
    bool is_seen;  /* in this frame */
    int32_t limb;
    int64_t first_ns, last_ns;
    rlf_vec3 first_palm;
    bool has_moved;     /* since then */
    rlf_gesture wished; /* seen but not yet told, */
    int32_t wishes;     /* in so many frames in a row */
    double right;       /* sum of hand_seen.right */
    hand_motion motion;
} hand_track;

typedef struct hand_follow {
    hand_track track[RLF_HANDS_MAX]; /* id 0 = free */
    int32_t next_id;
    double smooth_hz, smooth_opening;
} hand_follow;

/* Matches what is seen to what is followed, smooths, and fills hands and events of `out`. */
void hand_follow_update(hand_follow *f, hand_seen *seen, int32_t count, rlf_hands *out);

/* events.c: one more event, if there is room. */
void hand_event_add(rlf_hands *out, const rlf_hand *hand, rlf_hand_event_kind kind);
/* What a change of gesture begins and ends. */
void hand_events_of_gesture(rlf_hands *out, const rlf_hand *hand, rlf_gesture before);
/* Push, swipes and wave, from where the hand has been. */
void hand_events_of_motion(rlf_hands *out, const rlf_hand *hand, hand_motion *motion);

#endif
