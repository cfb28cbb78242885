/* What another's hands do: grasps of six kinds, aborted ones, and a hand among bodies. */
#ifndef RELIEF_LAB_EVAL_HANDS_ACT_H
#define RELIEF_LAB_EVAL_HANDS_ACT_H

#include "eval/hands/another.h"

#define ACT_KINDS 6      /* grasps; in the order of rlf_synthetic_act */
#define ACT_GRIPS_MAX 96 /* of one script */
#define ACT_BODIES_MAX 3

typedef enum act_kind {
    ACT_PINCH_ABOVE = 0,
    ACT_PINCH_SIDE = 1,
    ACT_BAR = 2,
    ACT_TWO_HANDS = 3,
    ACT_SCOOP = 4,
    ACT_UNDER = 5,
    ACT_AMONG = 6 /* passes, pushes, strokes, rests; grasps none */
} act_kind;

/* Where a hand is and how it is bent at a time; between two it goes smoothly. Stage frame: y up,
 * origin on the table, the person at +z; of a left hand. */
typedef struct act_key {
    double time;
    rlf_pose at;
    another_grip grip;
    double late[5]; /* s by which each digit comes after the others */
} act_key;

typedef struct another_act {
    act_kind kind;
    bool is_aborted; /* the hand closes beside the body */
    int32_t view;    /* 0 front, 1 above, 2 side */
    another_hand hand[2];
    int32_t hand_count;
    act_key key[ACT_GRIPS_MAX];
    int32_t key_count;
    rlf_pose T_camera_stage;
    rlf_shape body;
    rlf_pose T_stage_body[ACT_BODIES_MAX], T_hand_body; /* hand: of the first hand, as it holds */
    int32_t body_count;
    double release, begin, closed, lifted, carried, opened, let_go, end, rise;
} another_act;

/* Draws lots for all of it. */
void another_act_draw(another_act *act, act_kind kind, bool is_aborted, eval_random *r);
/* The room's table, floor and wall. */
void another_act_room(const another_act *act, another_view *view);
/* Puts the hands where they are at that time; how many there are to be seen. */
int32_t another_act_pose(another_act *act, double time);

#endif
