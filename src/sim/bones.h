/* The rigid segments of everything that moves, and the solids that are fixed to each. */
#ifndef RLF_SIM_BONES_H
#define RLF_SIM_BONES_H

#include "sim/gait.h"
#include "sim/scene.h"

/* Limbs come in pairs: left, right. A bone's frame has its origin at its upper joint, y along the
 * bone to the lower joint and z forward (hands: z out of the back of the hand). */
typedef enum synth_bone {
    SYNTH_PELVIS = 0,
    SYNTH_CHEST,
    SYNTH_HEAD,
    SYNTH_UPPER_ARM,
    SYNTH_FOREARM = SYNTH_UPPER_ARM + 2,
    SYNTH_PALM = SYNTH_FOREARM + 2,
    SYNTH_THIGH = SYNTH_PALM + 2,
    SYNTH_SHIN = SYNTH_THIGH + 2,
    SYNTH_FOOT = SYNTH_SHIN + 2,
    SYNTH_BOOK_BONE = SYNTH_FOOT + 2,
    SYNTH_FINGER,                        /* four proximal segments ... */
    SYNTH_FINGER_TIP = SYNTH_FINGER + 4, /* ... and four distal ones */
    SYNTH_THUMB = SYNTH_FINGER_TIP + 4,
    SYNTH_BONE_COUNT
} synth_bone;

/* Bones of a body of that figure in that moment of its walk, on the floor of the scene. */
void synth_set_bones(const synth_scene *scene, const synth_figure *figure, const synth_gait *gait,
                     rlf_pose *bones);

/* Bones now and on both sides of now. */
typedef struct synth_motion {
    rlf_pose before[SYNTH_BONE_COUNT];
    rlf_pose now[SYNTH_BONE_COUNT];
    rlf_pose after[SYNTH_BONE_COUNT];
} synth_motion;

#define SYNTH_DIFFERENCE_S 1e-3 /* from now to either side: error ~ h^2 / 6 jerk */

/* put.c: adds a mover that moves with its bone. */
void synth_put_flesh(synth_scene *scene, const synth_flesh *flesh, int32_t label,
                     const synth_motion *m);

/* Bones of the person (and the book he holds) at time t, in the camera frame. */
void synth_person_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT]);
/* Bones of the second person of scene "crossing". */
void synth_second_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT]);
/* Bones of the arm in front of the camera at time t. */
void synth_hand_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT]);

/* Bones of the tray (SYNTH_BOOK_BONE) and the arm that holds it at time t. */
void synth_tray_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT]);

/* Middle joint of a chain of two bones from `root` towards `target`, bent towards `pole`. The end
 * joint, which is the target where the chain is long enough, goes to *target. */
rlf_vec3 synth_bend(rlf_vec3 root, rlf_vec3 *target, double upper, double lower, rlf_vec3 pole);

/* Pose at `origin` with y along `direction` and z as near to `forward` as possible. */
rlf_pose synth_bone_pose(rlf_vec3 origin, rlf_vec3 direction, rlf_vec3 forward);

extern const synth_flesh synth_hand_flesh[];
extern const int32_t synth_hand_flesh_count;
extern const synth_flesh synth_book_flesh;
extern const synth_flesh synth_tray_flesh[2]; /* tray, arm */

#endif
