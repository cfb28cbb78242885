/* Relief: hands of the synthetic room that grasp and gesture by a script, with the truth of them.
 *
 * Scene "hands": a table, a person behind it, and one or two hands of true proportion (Buryanov
 * and Kotiuk 2010, Proportions of hand segments) that do one act. The body to be grasped is
 * virtual, so no depth picture shows it: the fingers close on where it stands. Who puts it there
 * reads rlf_synthetic_get_task. SPDX-License-Identifier: MIT */
#ifndef RELIEF_SYNTHETIC_HANDS_H
#define RELIEF_SYNTHETIC_HANDS_H

#include "relief/source.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the hands do; the names in a source string are these in small letters. */
typedef enum rlf_synthetic_act {
    RLF_SYNTHETIC_ACT_PINCH_ABOVE = 0, /* grasps: thumb and fingers, from above */
    RLF_SYNTHETIC_ACT_PINCH_SIDE = 1,  /* the same, level */
    RLF_SYNTHETIC_ACT_FIST_BAR = 2,    /* a fist around an upright bar */
    RLF_SYNTHETIC_ACT_TWO_HANDS = 3,   /* flat hands at two sides of it */
    RLF_SYNTHETIC_ACT_SCOOP = 4,       /* in the hollow of the hand; let go by turning it over */
    RLF_SYNTHETIC_ACT_UNDER = 5,       /* on the flat hand; the same */
    RLF_SYNTHETIC_ACT_THROW = 6,       /* as pinch_side, opened at full swing */
    RLF_SYNTHETIC_ACT_PASS = 7,        /* a hand moves among bodies, pushes them, grasps none */
    RLF_SYNTHETIC_ACT_OPEN = 8,        /* gestures of a raised hand, each three times */
    RLF_SYNTHETIC_ACT_FIST = 9,        /* the thumb over the fingers */
    RLF_SYNTHETIC_ACT_PINCH = 10,      /* thumb and index meet in a ring */
    RLF_SYNTHETIC_ACT_POINT = 11,      /* the index, the others as in a fist */
    RLF_SYNTHETIC_ACT_FLAT = 12,       /* fingers together */
    RLF_SYNTHETIC_ACT_SWIPE = 13,      /* an open hand to one side and back, three times */
    RLF_SYNTHETIC_ACT_WAVE = 14,       /* to and fro, six times over */
    RLF_SYNTHETIC_ACT_COUNT = 15       /* so many there are */
} rlf_synthetic_act;

/* Where the camera is: before the person, above the table, or beside it. */
typedef enum rlf_synthetic_view {
    RLF_SYNTHETIC_VIEW_FRONT = 0, /* 15 to 30 degrees above the table */
    RLF_SYNTHETIC_VIEW_ABOVE = 1, /* 60 to 78 degrees */
    RLF_SYNTHETIC_VIEW_SIDE = 2   /* 55 to 80 degrees to one side, 10 to 30 above */
} rlf_synthetic_view;

/* The virtual body. */
typedef enum rlf_synthetic_body {
    RLF_SYNTHETIC_BODY_CUBE = 0, /* `size` is its edge */
    RLF_SYNTHETIC_BODY_BALL = 1, /* its diameter */
    RLF_SYNTHETIC_BODY_CAN = 2   /* its diameter; 1.3 times as high. A bar is a long one */
} rlf_synthetic_body;

/* Of scene "hands" only; a part of rlf_synthetic_def. */
typedef struct rlf_synthetic_hands_def {
    rlf_synthetic_act act;   /* default pinch_above */
    rlf_synthetic_view view; /* default front */
    double distance;         /* camera to the middle of the action, metres, 0.6..3; default 0.9 */
    rlf_synthetic_body body; /* default cube; of fist_bar always a bar */
    double size;             /* metres, 0.03..0.2; 0 = drawn by the seed; default 0 */
    double hold;             /* s that the hand waits, still, before it opens; default 0.5 */
} rlf_synthetic_hands_def;

/* Name of an act as in a source string; NULL outside. */
RLF_API const char *rlf_synthetic_act_name(rlf_synthetic_act act);

/* What a hand shows; the values are those of rlf_gesture. NONE while it changes or does another
 * thing. */
typedef enum rlf_synthetic_gesture {
    RLF_SYNTHETIC_GESTURE_NONE = 0,  /* grasps, and fingers on their way */
    RLF_SYNTHETIC_GESTURE_OPEN = 1,  /* also of acts flat, swipe and wave */
    RLF_SYNTHETIC_GESTURE_FIST = 2,  /* of act fist */
    RLF_SYNTHETIC_GESTURE_PINCH = 3, /* of act pinch */
    RLF_SYNTHETIC_GESTURE_POINT = 4  /* of act point */
} rlf_synthetic_gesture;

/* One hand in truth; points in the depth camera's frame, metres. Fingers count from the thumb. */
typedef struct rlf_synthetic_hand {
    bool is_left;           /* its owner's left one */
    double length;          /* wrist to the end of the middle finger, stretched: 0.160..0.205 */
    rlf_pose T_camera_hand; /* origin at the wrist, y to the fingers, z out of the back */
    /* The palm's middle, between its skin and the back's. */
    rlf_vec3 palm;
    rlf_vec3 palm_normal;          /* unit, out of the palm */
    double palm_half;              /* from there to the skin along the normal, both ways */
    rlf_vec3 velocity;             /* of palm, m/s */
    rlf_vec3 joints[5][4];         /* inside the hand: root, two more, middle of the round tip */
    double tip_radius[5];          /* of the round tips */
    rlf_synthetic_gesture gesture; /* shown at this time */
    double pinch_width;            /* gap between the skin of thumb and index tip, >= 0 */
} rlf_synthetic_hand;

/* Most bodies of one act, and most hands. */
#define RLF_SYNTHETIC_BODIES_MAX 3
/* Most hands of one act. */
#define RLF_SYNTHETIC_HANDS_MAX 2

/* Where the virtual bodies stand, and when the hands do what with the first. Acts that grasp
 * nothing have no bodies (pass has three); times are then 0. */
typedef struct rlf_synthetic_task {
    int32_t body_count;      /* 0..RLF_SYNTHETIC_BODIES_MAX, all alike */
    rlf_synthetic_body body; /* what they are */
    rlf_vec3 size;           /* extents along its own axes, metres; y is upright */
    /* Of their middles, before anybody takes them. */
    rlf_pose T_camera_body[RLF_SYNTHETIC_BODIES_MAX];
    double release; /* s: it hangs in the air until then; 0 = it stands on the table */
    double closed;  /* s: the fingers are closed on it ... */
    double lifted;  /* ... it has risen by `rise` metres ... */
    double carried; /* ... it has been carried half a metre aside ... */
    double opened;  /* ... and the fingers begin to open */
    double end;     /* s: the script is over */
    double rise;    /* metres */
    /* Zero of acts that throw nothing. */
    rlf_vec3 thrown; /* of a throw: velocity of the grasped point as the hand opens, m/s */
} rlf_synthetic_task;

/* The hands at any time, seconds since the source's first frame, >= 0: out[0..*out_count), at most
 * RLF_SYNTHETIC_HANDS_MAX. RLF_ERROR_INVALID when the source is not scene "hands".
 * Thread-safety: as rlf_source_next. */
RLF_API rlf_result rlf_synthetic_get_hands(rlf_source *source, double time_s,
                                           rlf_synthetic_hand *out, int32_t *out_count);
/* The script's bodies and times. RLF_ERROR_INVALID when the source is not scene "hands". */
RLF_API rlf_result rlf_synthetic_get_task(const rlf_source *source, rlf_synthetic_task *out);

#ifdef __cplusplus
}
#endif
#endif
