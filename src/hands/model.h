/* A hand of round cones: its joints' angles, and what each cone and each angle moves. */
#ifndef RLF_HANDS_MODEL_H
#define RLF_HANDS_MODEL_H

#include "relief/math.h"

#define MODEL_PALM 6
#define MODEL_HAND (MODEL_PALM + 15) /* cones of the hand: the palm's, three of each digit, */
#define MODEL_CONES (MODEL_HAND + 2) /* and the forearm's */
#define MODEL_JOINTS 23              /* turns: 5 of the thumb, 4 of each finger, 2 of the wrist */
#define MODEL_CHAIN 5                /* most turns that move one cone */

/* Unknowns: of all (3 metres along, 3 rad about the camera's axes), and angles, radians. */
enum {
    MODEL_THUMB = 6,   /* aside, forward, twist, middle and last joint */
    MODEL_FINGER = 11, /* of index to little: spread, first and middle joint */
    MODEL_WRIST = 23,  /* bent to the palm, aside */
    MODEL_UNKNOWNS = 25,
    MODEL_ANGLES = MODEL_UNKNOWNS - MODEL_THUMB
};

/* Its frame: origin at the wrist, y to the fingers, z out of the back, the thumb on the side of +x
 * of a left hand and of -x of a right one. */
typedef struct hand_model_pose {
    rlf_vec3 at;
    rlf_quat q;
    double angle[MODEL_ANGLES]; /* as the unknowns from MODEL_THUMB on */
    bool is_left;
} hand_model_pose;

#define MODEL_LENGTH_M 0.185 /* wrist to the end of the middle finger: the mean of adults */

/* A turn of what lies beyond a joint, camera frame. */
typedef struct hand_turn {
    rlf_vec3 axis, centre;
    double share; /* of its unknown */
    int32_t unknown;
} hand_turn;

/* The hand in that pose, camera frame. */
typedef struct hand_model {
    rlf_vec3 a[MODEL_CONES], b[MODEL_CONES]; /* middles of a cone's round ends, */
    double radius_a[MODEL_CONES], radius_b[MODEL_CONES];
    hand_turn turn[MODEL_JOINTS];
    rlf_vec3 palm;        /* middle of the palm: turns of all are about it */
    rlf_vec3 y, z;        /* the frame's axes: to the fingers, out of the back */
    rlf_vec3 joint[5][4]; /* of a digit from its root to the middle of its round tip */
} hand_model;

extern const double hand_model_mean[MODEL_ANGLES]; /* at rest */
extern const double hand_model_low[MODEL_ANGLES], hand_model_high[MODEL_ANGLES];

void hand_model_build(hand_model *m, const hand_model_pose *pose);

/* The turns that move cone k: m->turn[*first] and so many after it. */
int32_t hand_model_chain(int32_t cone, int32_t *first);

/* Adds a step of all unknowns, angles kept within their limits. */
void hand_model_step(hand_model_pose *pose, const hand_model *m, const double *step);

/* 0 bent .. 1 stretched: a finger's end from its root, of its length; 0 is the thumb. */
double hand_model_stretch(const hand_model *m, int32_t digit);

#endif
