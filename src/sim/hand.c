/* An arm from below whose hand moves close to the camera, opening and closing. */
#include "sim/bones.h"
#include "sim/gait.h"

#define ENTER_BEGIN 0.5 /* s; the hand is out of view before */
#define ENTER_END 1.7

static rlf_vec3 wrist_at(double t)
{
    double raised = synth_smooth((t - ENTER_BEGIN) / (ENTER_END - ENTER_BEGIN));
    double phase = rlf_max(0.0, t - ENTER_END);
    return rlf_vec3_make(0.06 + 0.14 * rlf_sin(0.9 * phase),
                         1.20 - 1.08 * raised + 0.05 * rlf_sin(1.7 * phase),
                         0.90 + 0.27 * rlf_cos(1.3 * phase));
}

/* Pose of a segment fixed at `origin` of the palm that points along `direction` of the palm. */
static rlf_pose on_palm(const rlf_pose *palm, rlf_vec3 origin, rlf_vec3 direction)
{
    rlf_vec3 back = rlf_rotate(palm->q, rlf_vec3_make(0, 0, 1));
    return synth_bone_pose(rlf_transform(palm, origin), rlf_rotate(palm->q, direction), back);
}

static void set_fingers(double curl, rlf_pose *bones)
{
    static const double root_x[4] = {-0.030, -0.010, 0.011, 0.030};
    static const double root_y[4] = {0.100, 0.108, 0.103, 0.088};
    static const double length[4] = {0.045, 0.050, 0.046, 0.036};
    const rlf_pose *palm = &bones[SYNTH_PALM];
    for (int i = 0; i < 4; i++) {
        double spread = 0.09 * (i - 1.4) * (1.0 - curl);
        double first = 1.2 * curl + 0.1;
        double second = 2.4 * curl + 0.2;
        rlf_vec3 root = rlf_vec3_make(root_x[i], root_y[i], 0.0);
        rlf_vec3 near = rlf_normalize(rlf_vec3_make(spread, rlf_cos(first), -rlf_sin(first)));
        rlf_vec3 tip = rlf_normalize(rlf_vec3_make(spread, rlf_cos(second), -rlf_sin(second)));
        bones[SYNTH_FINGER + i] = on_palm(palm, root, near);
        bones[SYNTH_FINGER_TIP + i] = on_palm(palm, rlf_mad(root, near, length[i]), tip);
    }
    rlf_vec3 thumb = rlf_vec3_make(-0.75 + 0.5 * curl, 0.65, -0.2 - 0.4 * curl);
    bones[SYNTH_THUMB] = on_palm(palm, rlf_vec3_make(-0.030, 0.030, -0.004), thumb);
}

void synth_hand_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT])
{
    (void)scene;
    rlf_vec3 wrist = wrist_at(t);
    rlf_vec3 forearm = rlf_normalize(rlf_vec3_make(-0.25, -0.96, 0.10));
    rlf_vec3 elbow = rlf_mad(wrist, forearm, -0.25);
    rlf_vec3 arm = rlf_normalize(rlf_vec3_make(-0.12, -0.98, 0.15));
    rlf_vec3 towards_camera = rlf_vec3_make(0, 0, -1);
    rlf_vec3 fingers = rlf_vec3_make(0.15 * rlf_sin(1.1 * t), -1.0, 0.12);
    double curl = 0.5 - 0.5 * rlf_cos(1.6 * rlf_max(0.0, t - ENTER_END));
    bones[SYNTH_UPPER_ARM] = synth_bone_pose(rlf_mad(elbow, arm, -0.6), arm, towards_camera);
    bones[SYNTH_FOREARM] = synth_bone_pose(elbow, forearm, towards_camera);
    bones[SYNTH_PALM] = synth_bone_pose(wrist, fingers, towards_camera);
    set_fingers(curl, bones);
}
