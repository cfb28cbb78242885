/* Another's hand: drawn with other proportions and sections than the simulator's, for judging. */
#ifndef RELIEF_LAB_EVAL_HANDS_ANOTHER_H
#define RELIEF_LAB_EVAL_HANDS_ANOTHER_H

#include "eval/analytic.h"
#include "relief/hands.h"
#include "relief/snapshot.h"

#define ANOTHER_WIDTH 512
#define ANOTHER_HEIGHT 424

/* Angles, radians: of thumb and fingers the first joint, the middle and the last; and to the side.
 */
typedef struct another_grip {
    double bend[5][3], aside[5];
    rlf_gesture gesture;
} another_grip;

/* Whose hand, and where it is. Its frame: origin at the wrist, y to the fingers, z out of the back,
 * x to the thumb of a left hand. */
typedef struct another_hand {
    double length; /* wrist to the end of the middle finger, metres */
    bool is_left, has_sleeve;
    double finger[5], breadth; /* shares of the usual */
    rlf_pose T_camera_hand;
    rlf_vec3 elbow, shoulder, chest; /* camera frame */
    another_grip grip;
    rlf_vec3 tip[5], palm; /* out: middle of the tips' ends, and of the palm */
} another_hand;

#define ANOTHER_CONES 21

/* From a to b, round. */
typedef struct another_cone {
    rlf_vec3 a, b;
    double radius;
} another_cone;

/* A picture of it before a chest and a wall, as a surface. */
typedef struct another_view another_view;
another_view *another_view_create(void);
void another_view_destroy(another_view *view);

/* A hand of one of five sizes and of either side. */
void another_hand_draw_lots(another_hand *hand, eval_random *r);
/* A grip of that gesture as people make it: no two are alike. NONE: at rest. */
another_grip another_grip_draw_lots(const another_hand *hand, rlf_gesture gesture, eval_random *r);
another_grip another_grip_mix(const another_grip *a, const another_grip *b, double share);

/* A face of the room: n.p = offset, as far as `radius` about `middle`; camera frame. */
typedef struct another_plane {
    rlf_vec3 normal;
    double offset;
    rlf_vec3 middle;
    double radius;
} another_plane;

/* Another room than a wall at 2.6 m. */
void another_view_room(another_view *view, const another_plane *planes, int32_t count, rlf_vec3 up);
/* Velocity of all that moves in the surface of the last frame, m/s; still until then. */
void another_view_flow(another_view *view, rlf_vec3 velocity);
/* The sensor; its pictures are the surface's depth. */
const rlf_rig *another_view_rig(another_view *view);

/* Draws the next frame, with a sensor's noise, mixed edges and gaps. Fills tips and palms. */
const rlf_surface *another_view_show(another_view *view, another_hand *hands, int32_t count,
                                     eval_random *r, int64_t time_ns);

/* Skin of the hand's solids as round cones, camera frame: the palm's six, and three a digit. */
void another_hand_cones(const another_hand *hand, another_cone out[ANOTHER_CONES]);
/* Least distance of digit's skin to a shape at that pose in the hand's frame, metres. */
double another_hand_distance(const another_hand *hand, const another_grip *grip, int32_t digit,
                             const rlf_shape *shape, const rlf_pose *T_hand_body);
/* The end of a digit in the hand's frame, metres. */
rlf_vec3 another_hand_tip(const another_hand *hand, const another_grip *grip, int32_t digit);

#endif
