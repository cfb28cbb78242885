/* A hand that moves among bodies, beside, above and against them, and grasps none. */
#include "sim/hands/hands.h"
#include "sim/hash.h"

#define LEGS 12    /* ways of the hand ... */
#define LEG_S 0.75 /* ... in seconds each */
#define APART 0.22 /* metres between the bodies */
#define SIZE 0.07

static void put_bodies(synth_hands *hands, synth_draw *d)
{
    rlf_synthetic_task *task = &hands->task;
    double size = hands->def.size > 0.0 ? hands->def.size : SIZE;
    task->body_count = RLF_SYNTHETIC_BODIES_MAX;
    task->body = hands->def.body;
    task->size = rlf_vec3_make(size, size, size);
    task->size.y *= task->body == RLF_SYNTHETIC_BODY_CAN ? 1.3 : 1.0;
    for (int i = 0; i < task->body_count; i++) {
        rlf_pose *at = &task->T_camera_body[i];
        at->p = rlf_scale(hands->across, APART * (i - 1));
        at->p.y = -0.5 * task->size.y;
        at->q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), synth_draw_range(d, -0.8, 0.8));
    }
}

/* Palm down or on edge, at one of the bodies or between two, over the table or over them all. */
static rlf_pose draw_place(const synth_hands *hands, synth_draw *d)
{
    const synth_hand_form *form = &hands->tracks[0].form;
    double side = form->is_left ? -1.0 : 1.0, half;
    bool is_edge = synth_draw_chance(d, 0.4), is_low = synth_draw_chance(d, 0.7);
    rlf_vec3 palm = synth_hand_palm(form, &half);
    rlf_vec3 fingers = {synth_draw_range(d, -0.5, 0.5), 0.1, -1};
    rlf_pose at;
    at.q =
        synth_hands_turn(fingers, is_edge ? rlf_vec3_make(-side, 0, 0) : rlf_vec3_make(0, -1, 0));
    rlf_vec3 middle = rlf_scale(hands->across, synth_draw_range(d, -1.6, 1.6) * APART);
    middle.z += synth_draw_range(d, -0.05, 0.12);
    middle.y = is_low ? -synth_draw_range(d, 0.055, 0.075) : -synth_draw_range(d, 0.10, 0.16);
    at.p = rlf_sub(middle, rlf_rotate(at.q, palm));
    return at;
}

void synth_hands_script_pass(synth_hands *hands, synth_draw *d)
{
    static const synth_grip_name names[4] = {SYNTH_GRIP_RELAXED, SYNTH_GRIP_FLAT, SYNTH_GRIP_OPEN,
                                             SYNTH_GRIP_FIST};
    const synth_grip relaxed = synth_grip_named(SYNTH_GRIP_RELAXED);
    rlf_pose at = synth_hands_home(hands, 0);
    double t = SYNTH_HANDS_THERE;
    put_bodies(hands, d);
    synth_track_add(&hands->tracks[0], t, &at, &relaxed, 0, SYNTH_EASE_SMOOTH);
    for (int k = 0; k < LEGS; k++) {
        synth_grip grip = synth_grip_named(names[synth_draw_index(d, 4)]);
        bool is_rest = k > 0 && synth_draw_chance(d, 0.2);
        at = is_rest ? at : draw_place(hands, d);
        t += LEG_S;
        synth_track_add(&hands->tracks[0], t, &at, &grip, 0, SYNTH_EASE_SMOOTH);
    }
    hands->task.end = t;
}
