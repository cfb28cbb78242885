/* A hand's keys, and what lies between them. */
#include "sim/gait.h"
#include "sim/hands/hands.h"

#define RAMP 0.15 /* s in which a steady motion reaches its speed, at most a third of it */

void synth_track_add(synth_track *track, double time, const rlf_pose *hand, const synth_grip *grip,
                     int32_t gesture, synth_ease ease)
{
    if (track->count < SYNTH_KEYS_MAX) {
        track->keys[track->count++] = (synth_key){time, *hand, *grip, gesture, ease};
    }
}

/* 0..1 over `duration`: speeds up evenly, goes on, slows down evenly. */
static double steady(double t, double duration)
{
    double ramp = rlf_min(RAMP, duration / 3.0);
    double speed = 1.0 / (duration - ramp);
    if (t < ramp) {
        return 0.5 * speed * t * t / ramp;
    }
    if (t > duration - ramp) {
        double left = duration - t;
        return 1.0 - 0.5 * speed * left * left / ramp;
    }
    return speed * (t - 0.5 * ramp);
}

/* 0..1 */
static double eased(synth_ease ease, double t, double duration)
{
    double x = t / duration;
    switch (ease) {
    case SYNTH_EASE_STEADY: return steady(t, duration);
    case SYNTH_EASE_LINEAR: return x;
    case SYNTH_EASE_SPEED_UP: return x * x;
    case SYNTH_EASE_SLOW_DOWN: return 1.0 - (1.0 - x) * (1.0 - x);
    default: return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x); /* least jerk */
    }
}

static rlf_quat turn_between(rlf_quat a, rlf_quat b, double share)
{
    double dot = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w, sign = dot < 0.0 ? -1.0 : 1.0;
    double u = 1.0 - share, v = sign * share;
    return rlf_quat_normalize(
        (rlf_quat){u * a.x + v * b.x, u * a.y + v * b.y, u * a.z + v * b.z, u * a.w + v * b.w});
}

synth_key synth_track_at(const synth_track *track, double t)
{
    int32_t i = 0;
    while (i < track->count && track->keys[i].time <= t) {
        i++;
    }
    if (i == 0 || i == track->count) {
        synth_key key = track->keys[i == 0 ? 0 : i - 1];
        key.time = t;
        return key;
    }
    const synth_key *a = &track->keys[i - 1], *b = &track->keys[i];
    double share = eased(b->ease, t - a->time, b->time - a->time);
    synth_key key = {.time = t, .gesture = a->gesture, .ease = b->ease};
    key.hand.p = rlf_mad(a->hand.p, rlf_sub(b->hand.p, a->hand.p), share);
    key.hand.q = turn_between(a->hand.q, b->hand.q, share);
    key.grip = synth_grip_mix(&a->grip, &b->grip, share);
    return key;
}
