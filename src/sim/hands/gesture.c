/* Scripts that show a gesture with a raised hand, three times. */
#include "sim/hands/hands.h"
#include "sim/hash.h"

#define DEGREE (RLF_PI / 180.0)
#define TIMES 3
#define RAISED 0.9 /* s from the waiting place to the raised one */

static const struct {
    synth_grip_name grip;
    int32_t gesture;
} shown[RLF_SYNTHETIC_ACT_COUNT] = {
    [RLF_SYNTHETIC_ACT_OPEN] = {SYNTH_GRIP_OPEN, RLF_SYNTHETIC_GESTURE_OPEN},
    [RLF_SYNTHETIC_ACT_FIST] = {SYNTH_GRIP_FIST, RLF_SYNTHETIC_GESTURE_FIST},
    [RLF_SYNTHETIC_ACT_PINCH] = {SYNTH_GRIP_CLOSED, RLF_SYNTHETIC_GESTURE_PINCH},
    [RLF_SYNTHETIC_ACT_POINT] = {SYNTH_GRIP_POINT, RLF_SYNTHETIC_GESTURE_POINT},
    [RLF_SYNTHETIC_ACT_FLAT] = {SYNTH_GRIP_FLAT, RLF_SYNTHETIC_GESTURE_OPEN},
    [RLF_SYNTHETIC_ACT_SWIPE] = {SYNTH_GRIP_OPEN, RLF_SYNTHETIC_GESTURE_OPEN},
    [RLF_SYNTHETIC_ACT_WAVE] = {SYNTH_GRIP_OPEN, RLF_SYNTHETIC_GESTURE_OPEN},
};

/* A raised hand that faces the camera, or half of it from the side; from above, its back. */
static rlf_pose raised(const synth_hands *hands, synth_draw *d)
{
    const double side = hands->tracks[0].form.is_left ? 1.0 : -1.0;
    double turn = synth_draw_range(d, -20.0, 20.0) * DEGREE, tilt = 20.0 * DEGREE;
    double lean = synth_draw_range(d, -tilt, tilt);
    rlf_vec3 fingers = {rlf_sin(lean), -rlf_cos(lean), synth_draw_range(d, -0.3, 0.1)};
    rlf_vec3 back = {rlf_sin(turn), 0, rlf_cos(turn)};
    rlf_pose at = {{0.20 * side, -0.22, 0.10}, rlf_quat_identity()};
    if (hands->def.view == RLF_SYNTHETIC_VIEW_ABOVE) {
        fingers = rlf_vec3_make(rlf_sin(lean), -0.15, -rlf_cos(lean));
        bool is_ring = hands->def.act == RLF_SYNTHETIC_ACT_PINCH; /* on edge, so that it shows */
        back = rlf_vec3_make((is_ring ? 1.2 * side : 0.0) + rlf_sin(turn), -1, 0.15);
        at.p = rlf_vec3_make(0.08 * side, -0.14, 0.10);
    } else if (hands->def.view == RLF_SYNTHETIC_VIEW_SIDE) {
        rlf_vec3 to_camera = rlf_transform_inverse(&hands->T_camera_stage, rlf_vec3_make(0, 0, 0));
        back = rlf_vec3_make(-to_camera.x / rlf_length(to_camera), 0, 1.0);
    }
    at.q = synth_hands_turn(fingers, back);
    return at;
}

/* A little somewhere else and turned otherwise. */
static rlf_pose drifted(const rlf_pose *pose, synth_draw *d)
{
    rlf_pose out = *pose;
    double *at[3] = {&out.p.x, &out.p.y, &out.p.z};
    double turn[3];
    for (int k = 0; k < 3; k++) {
        *at[k] += synth_draw_range(d, -0.025, 0.025);
        turn[k] = synth_draw_range(d, -0.12, 0.12);
    }
    rlf_quat q = rlf_quat_from_rotation_vector(rlf_vec3_make(turn[0], turn[1], turn[2]));
    out.q = rlf_quat_normalize(rlf_quat_mul(q, out.q));
    return out;
}

/* Shows the grip for a while, then rests. Returns when that is over. */
static double show(synth_track *track, double t, const rlf_pose *at, const synth_grip *grip,
                   int32_t gesture, synth_draw *d)
{
    const synth_grip relaxed = synth_grip_named(SYNTH_GRIP_RELAXED);
    rlf_pose pose = drifted(at, d);
    synth_track_add(track, t + 0.3, &pose, grip, gesture, SYNTH_EASE_SMOOTH);
    pose = drifted(at, d);
    synth_track_add(track, t + 0.9, &pose, grip, gesture, SYNTH_EASE_SMOOTH);
    pose = drifted(at, d);
    synth_track_add(track, t + 1.5, &pose, grip, 0, SYNTH_EASE_SMOOTH);
    synth_track_add(track, t + 1.8, &pose, &relaxed, 0, SYNTH_EASE_SMOOTH);
    synth_track_add(track, t + 2.0, &pose, &relaxed, 0, SYNTH_EASE_SMOOTH);
    return t + 2.0;
}

static double swipe(const synth_hands *hands, synth_track *track, double t, const rlf_pose *at,
                    const synth_grip *grip)
{
    rlf_pose pose = *at;
    pose.p = rlf_mad(at->p, hands->across, 0.22);
    synth_track_add(track, t + 0.6, &pose, grip, RLF_SYNTHETIC_GESTURE_OPEN, SYNTH_EASE_SMOOTH);
    pose.p = rlf_mad(at->p, hands->across, -0.22);
    synth_track_add(track, t + 0.95, &pose, grip, RLF_SYNTHETIC_GESTURE_OPEN, SYNTH_EASE_SMOOTH);
    synth_track_add(track, t + 1.5, &pose, grip, RLF_SYNTHETIC_GESTURE_OPEN, SYNTH_EASE_SMOOTH);
    return t + 1.5;
}

/* To one side and to the other. */
static double wave(const synth_hands *hands, synth_track *track, double t, const rlf_pose *at,
                   const synth_grip *grip)
{
    for (int k = 0; k < 4; k++) {
        double side = k % 2 == 0 ? 1.0 : -1.0;
        rlf_vec3 axis = rlf_rotate(at->q, rlf_vec3_make(0, 0, 1));
        rlf_pose pose = {rlf_mad(at->p, hands->across, 0.06 * side), rlf_quat_identity()};
        pose.q = rlf_quat_mul(rlf_quat_from_axis_angle(axis, 0.35 * side), at->q);
        t += 0.3;
        synth_track_add(track, t, &pose, grip, RLF_SYNTHETIC_GESTURE_OPEN, SYNTH_EASE_SMOOTH);
    }
    return t;
}

void synth_hands_script_gesture(synth_hands *hands, synth_draw *d)
{
    const rlf_synthetic_act act = hands->def.act;
    synth_track *track = &hands->tracks[0];
    const synth_grip relaxed = synth_grip_named(SYNTH_GRIP_RELAXED);
    synth_grip grip = synth_grip_named(shown[act].grip);
    rlf_pose home = synth_hands_home(hands, 0), at = raised(hands, d);
    double t = SYNTH_HANDS_THERE + RAISED;
    if (act == RLF_SYNTHETIC_ACT_PINCH) {
        grip = synth_grip_ring(&track->form);
    }
    synth_track_add(track, SYNTH_HANDS_THERE, &home, &relaxed, 0, SYNTH_EASE_SMOOTH);
    synth_track_add(track, t, &at, &relaxed, 0, SYNTH_EASE_SMOOTH);
    for (int k = 0; k < TIMES; k++) {
        if (act == RLF_SYNTHETIC_ACT_SWIPE) {
            t = swipe(hands, track, t, &at, &grip);
        } else if (act == RLF_SYNTHETIC_ACT_WAVE) {
            t = wave(hands, track, t, &at, &grip);
        } else {
            t = show(track, t, &at, &grip, shown[act].gesture, d);
        }
    }
    hands->task.end = t;
}
