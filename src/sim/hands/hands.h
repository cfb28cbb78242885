/* Scene "hands": hands of true proportion, and the script that moves them. */
#ifndef RLF_SIM_HANDS_HANDS_H
#define RLF_SIM_HANDS_HANDS_H

#include "sim/hash.h"
#include "sim/scene.h"
#include "relief/synthetic_hands.h"

#define SYNTH_FINGERS 5   /* thumb, index, middle, ring, little */
#define SYNTH_HAND_PALM 6 /* the first solids: the palm; then three of each finger */
#define SYNTH_HAND_SOLIDS (SYNTH_HAND_PALM + 3 * SYNTH_FINGERS)
#define SYNTH_KEYS_MAX 40

/* Whose hand. Its frame has its origin at the wrist, y to the fingers and z out of the back; the
 * thumb is on the side of -x of a right hand and of +x of a left one. */
typedef struct synth_hand_form {
    double length; /* metres */
    bool is_left;
} synth_hand_form;

/* How far the fingers are bent. */
typedef struct synth_grip {
    rlf_vec3 thumb[3]; /* directions of its bones, hand frame of a left hand */
    double bend[4][2]; /* first and middle joint, radians; the last follows by two thirds */
    double spread;     /* radians between neighbours */
} synth_grip;

/* Solids and joints of a hand, in its frame. */
typedef struct synth_hand_shape {
    synth_shape solids[SYNTH_HAND_SOLIDS];
    rlf_vec3 joints[SYNTH_FINGERS][4]; /* the last is the middle of the round tip */
    double tip_radius[SYNTH_FINGERS];
} synth_hand_shape;

typedef enum synth_ease {
    SYNTH_EASE_SMOOTH = 0, /* least jerk */
    SYNTH_EASE_STEADY,     /* at one speed, with short ramps */
    SYNTH_EASE_LINEAR,
    SYNTH_EASE_SPEED_UP, /* evenly, from rest to twice the mean speed */
    SYNTH_EASE_SLOW_DOWN
} synth_ease;

/* From the key before to this one. */
typedef struct synth_key {
    double time;
    rlf_pose hand; /* stage frame */
    synth_grip grip;
    int32_t gesture; /* rlf_synthetic_gesture, from this key's time on */
    synth_ease ease;
} synth_key;

typedef struct synth_track {
    synth_hand_form form;
    synth_key keys[SYNTH_KEYS_MAX];
    int32_t count;
} synth_track;

/* The stage frame is level: its origin is the middle of the table's top, y down, and the person
 * stands at +z and looks along -z, x to his left. */
typedef struct synth_hands {
    rlf_synthetic_hands_def def;
    double speed;
    rlf_pose T_camera_stage;
    rlf_vec3 centre; /* what the camera looks at, stage frame */
    rlf_vec3 enter;  /* where the person comes from, stage frame */
    rlf_vec3 across; /* level, unit: across the picture */
    synth_track tracks[RLF_SYNTHETIC_HANDS_MAX];
    int32_t track_count;
    rlf_synthetic_task task; /* poses in the stage frame */
} synth_hands;

/* Draws the scene of def->seed into *scene (its other fields zero) and *hands, which the scene
 * keeps a pointer to. */
void synth_hands_build(synth_scene *scene, synth_hands *hands, const rlf_synthetic_def *def);
/* The movers at time t. */
void synth_hands_move(synth_scene *scene, double t);
/* How far the person still is from his place, stage frame. */
rlf_vec3 synth_hands_offset(const synth_hands *hands, double t);

/* anatomy.c */
void synth_hand_form_shape(const synth_hand_form *form, const synth_grip *grip,
                           synth_hand_shape *out);
/* Middle of the palm, hand frame, and from there to the skin. */
rlf_vec3 synth_hand_palm(const synth_hand_form *form, double *out_half);

/* grip.c: named grips, and between two of them. */
typedef enum synth_grip_name {
    SYNTH_GRIP_OPEN = 0,
    SYNTH_GRIP_FLAT,
    SYNTH_GRIP_RELAXED,
    SYNTH_GRIP_FIST,
    SYNTH_GRIP_POINT,
    SYNTH_GRIP_CUP,
    SYNTH_GRIP_WIDE,   /* thumb and fingers as far apart as they go ... */
    SYNTH_GRIP_CLOSED, /* ... and where they meet */
    SYNTH_GRIP_ROUND,  /* from WIDE around a bar */
    SYNTH_GRIP_COUNT
} synth_grip_name;
synth_grip synth_grip_named(synth_grip_name name);
synth_grip synth_grip_mix(const synth_grip *a, const synth_grip *b, double share);
/* Thumb and index meet in a ring. */
synth_grip synth_grip_ring(const synth_hand_form *form);
/* Each finger at its own share of the way from a to b. */
synth_grip synth_grip_mix_each(const synth_grip *a, const synth_grip *b,
                               const double share[SYNTH_FINGERS]);

/* contact.c: how fingers meet a body. */
/* Distance between a body (hand frame) and the hand's solids first .. first + count - 1. */
double synth_hand_distance(const synth_hand_shape *hand, int32_t first, int32_t count,
                           const synth_shape *body);
/* Share of the way from a to b at which each finger is `gap` away from the body; negative gaps
 * press. Fingers that never come so near stop at `most`. */
void synth_hand_close(const synth_hand_form *form, const synth_grip *a, const synth_grip *b,
                      const synth_shape *body, double gap, double most,
                      double share[SYNTH_FINGERS]);
/* Share of the way from WIDE to CLOSED at which the pads of thumb and fingers are `width` apart;
 * their middle and the unit axis from thumb to fingers, hand frame. */
double synth_hand_span(const synth_hand_form *form, double width, rlf_vec3 *out_middle,
                       rlf_vec3 *out_axis);

/* track.c */
void synth_track_add(synth_track *track, double time, const rlf_pose *hand, const synth_grip *grip,
                     int32_t gesture, synth_ease ease);
/* Pose, grip and gesture at time t; before the first key as there, after the last as there. */
synth_key synth_track_at(const synth_track *track, double t);

/* grasp.c, gesture.c: fill tracks and task; `d` gives the random numbers. */
void synth_hands_script_grasp(synth_hands *hands, synth_draw *d);
void synth_hands_script_gesture(synth_hands *hands, synth_draw *d);
/* pass.c */
void synth_hands_script_pass(synth_hands *hands, synth_draw *d);
/* pose.c */
/* Where a hand waits before and after: beside the body. */
rlf_pose synth_hands_home(const synth_hands *hands, int32_t track);
/* The body of the task as a solid, in the frame that T_body maps to. */
synth_shape synth_hands_body(const rlf_synthetic_task *task, const rlf_pose *T_body);
/* Turns vectors of the hand frame: y along `fingers`, z as near to `back` as it can be. */
rlf_quat synth_hands_turn(rlf_vec3 fingers, rlf_vec3 back);

#define SYNTH_HANDS_ENTER 0.5 /* s; the person comes ... */
#define SYNTH_HANDS_THERE 1.6 /* ... and stands, and his hands begin */

#endif
