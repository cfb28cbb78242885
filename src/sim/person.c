/* The person's skeleton: body from the gait, legs and arms by two-bone inverse kinematics. */
#include "sim/bones.h"
#include "sim/gait.h"

#define HIP_HEIGHT 0.925
#define THIGH_LENGTH 0.43
#define SHIN_LENGTH 0.42
#define ANKLE_HEIGHT 0.085
#define TOE_LENGTH 0.16   /* metres from the ankle forward to the middle of the toes */
#define HEEL_LENGTH 0.03  /* metres from the ankle back to the middle of the heel */
#define SOLE_RADIUS 0.038 /* metres; toes and heel are round: the foot rolls over either */
#define UPPER_ARM_LENGTH 0.29
#define FOREARM_LENGTH 0.25
#define BOOK_TURN_BEGIN 6.0 /* s */
#define BOOK_TURN_END 7.2

rlf_pose synth_bone_pose(rlf_vec3 origin, rlf_vec3 direction, rlf_vec3 forward)
{
    rlf_vec3 y = rlf_normalize(direction);
    rlf_vec3 x = rlf_normalize(rlf_cross(y, forward));
    rlf_vec3 z = rlf_cross(x, y);
    rlf_mat3 m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    rlf_pose pose = {origin, rlf_quat_from_mat3(&m)};
    return pose;
}

rlf_vec3 synth_bend(rlf_vec3 root, rlf_vec3 *target, double upper, double lower, rlf_vec3 pole)
{
    rlf_vec3 to_target = rlf_sub(*target, root);
    double length = rlf_length(to_target);
    rlf_vec3 direction = rlf_scale(to_target, 1.0 / length);
    length = rlf_min(length, 0.999 * (upper + lower));
    *target = rlf_mad(root, direction, length);
    double along = (length * length + upper * upper - lower * lower) / (2.0 * length);
    double aside = sqrt(rlf_max(0.0, upper * upper - along * along));
    rlf_vec3 side = rlf_mad(pole, direction, -rlf_dot(pole, direction));
    rlf_vec3 middle = rlf_mad(root, direction, along);
    return rlf_mad(middle, rlf_normalize(side), aside);
}

/* The body frame: origin on the floor, x to the person's right, y down, z ahead. */
static rlf_pose body_pose(const synth_scene *scene, const synth_gait *gait)
{
    rlf_pose pose;
    pose.p = rlf_add(gait->position, rlf_vec3_make(0, scene->floor_y, 0));
    pose.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), gait->heading);
    return pose;
}

/* Pelvis lowest in double support, chest turned against it, head level. */
static void set_trunk(const synth_figure *figure, const rlf_pose *body, const synth_gait *gait,
                      rlf_pose *bones)
{
    double dip = gait->walking * (0.0315 - 0.0215 * rlf_cos(2.0 * RLF_PI * gait->stride));
    double hip = (HIP_HEIGHT - dip) * figure->leg;
    hip += gait->sitting * (gait->seat - hip);
    double twist = 0.16 * gait->swing;
    double lean = 0.05 + 0.06 * gait->walking + 0.05 * gait->reach;
    rlf_pose pelvis = {rlf_vec3_make(0, -hip, 0),
                       rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.6 * twist)};
    rlf_quat chest_turn =
        rlf_quat_mul(rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), -twist - 0.22 * gait->reach),
                     rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), -lean));
    rlf_pose chest = {pelvis.p, chest_turn};
    rlf_vec3 neck = rlf_transform(&chest, rlf_vec3_make(0, -0.58 * figure->trunk, 0.0));
    rlf_pose head = {neck, rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), -0.05)};
    bones[SYNTH_PELVIS] = rlf_pose_mul(body, &pelvis);
    bones[SYNTH_CHEST] = rlf_pose_mul(body, &chest);
    bones[SYNTH_HEAD] = rlf_pose_mul(body, &head);
}

/* A foot behind the body rolls up over its toes, one ahead of it lands on the heel. */
static double foot_pitch(const rlf_pose *body, const synth_footing *foot, double walking)
{
    rlf_vec3 ground = foot->position;
    ground.y = 0.0;
    rlf_vec3 origin = body->p;
    origin.y = 0.0;
    double ahead = rlf_rotate(rlf_quat_conjugate(body->q), rlf_sub(ground, origin)).z;
    double lift = rlf_clamp(foot->position.y / 0.05, 0.0, 1.0);
    double roll = 0.65 * synth_smooth((-ahead - 0.08) / 0.26);
    double strike = 0.35 * lift * synth_smooth(ahead / 0.25);
    return walking * (roll - strike);
}

static void set_leg(const synth_figure *figure, const rlf_pose *body, const synth_gait *gait,
                    int side, rlf_pose *bones)
{
    double s = figure->leg;
    const synth_footing *footing = &gait->foot[side];
    double pitch = foot_pitch(body, footing, gait->walking);
    rlf_pose ground = {
        rlf_vec3_make(footing->position.x, body->p.y - footing->position.y, footing->position.z),
        rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), footing->heading)};
    double pivot = s * (pitch < 0.0 ? -HEEL_LENGTH : TOE_LENGTH);
    rlf_pose roll = {rlf_vec3_make(0, -s * SOLE_RADIUS, pivot),
                     rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), -pitch)};
    rlf_pose rolled = rlf_pose_mul(&ground, &roll);
    rlf_vec3 ankle =
        rlf_transform(&rolled, rlf_vec3_make(0, s * (SOLE_RADIUS - ANKLE_HEIGHT), -pivot));
    double offset = side == 0 ? -figure->hip : figure->hip;
    rlf_vec3 hip = rlf_transform(&bones[SYNTH_PELVIS], rlf_vec3_make(offset, 0.0, 0.0));
    rlf_vec3 forward = rlf_rotate(ground.q, rlf_vec3_make(0, 0, 1));
    rlf_vec3 knee = synth_bend(hip, &ankle, s * THIGH_LENGTH, s * SHIN_LENGTH, forward);
    bones[SYNTH_THIGH + side] = synth_bone_pose(hip, rlf_sub(knee, hip), forward);
    bones[SYNTH_SHIN + side] = synth_bone_pose(knee, rlf_sub(ankle, knee), forward);
    bones[SYNTH_FOOT + side] = (rlf_pose){ankle, rolled.q};
}

/* Where the hand of an adult of 1.75 m goes in the body frame when the arm does not merely swing.
 */
static rlf_vec3 gesture_target(const synth_scene *scene, const synth_gait *gait)
{
    if (scene->kind == RLF_SYNTHETIC_BOOK) {
        return rlf_vec3_make(0.10, -1.12, 0.40);
    }
    double t = rlf_max(0.0, gait->gesture_time - 0.5);
    double sweep = rlf_sin(2.6 * t);
    double rise = rlf_sin(1.7 * t);
    return rlf_vec3_make(0.16 + 0.20 * sweep, -1.24 - 0.12 * rise, 0.50 - 0.06 * sweep * sweep);
}

static void set_arm(const synth_scene *scene, const synth_figure *figure, const rlf_pose *body,
                    const synth_gait *gait, int side, rlf_pose *bones)
{
    double s = figure->arm;
    double sign = side == 0 ? -1.0 : 1.0;
    double swing = 0.42 * sign * gait->swing + 0.06;
    rlf_vec3 shoulder = rlf_transform(
        &bones[SYNTH_CHEST], rlf_vec3_make(sign * figure->shoulder, -figure->shoulder_height, 0.0));
    double length = s * (0.525 - 0.03 * gait->walking);
    rlf_vec3 hanging = rlf_vec3_make(sign * (0.055 + figure->clear), length * rlf_cos(swing),
                                     length * rlf_sin(swing) + 0.02);
    rlf_vec3 wrist = rlf_add(shoulder, rlf_rotate(body->q, hanging));
    double reach = scene->kind == RLF_SYNTHETIC_BOOK ? 1.0 : gait->reach;
    if (side == 1 && reach > 0.0) {
        rlf_vec3 target = rlf_transform(body, rlf_scale(gesture_target(scene, gait), s));
        /* out and up on an arc, not through the hip */
        rlf_vec3 arc = rlf_rotate(body->q, rlf_vec3_make(0.0, 0.0, 0.25 * reach * (1.0 - reach)));
        wrist = rlf_add(rlf_mad(wrist, rlf_sub(target, wrist), reach), arc);
    }
    rlf_vec3 pole = rlf_rotate(body->q, rlf_vec3_make(sign * 0.35, 0.25, -1.0));
    rlf_vec3 elbow = synth_bend(shoulder, &wrist, s * UPPER_ARM_LENGTH, s * FOREARM_LENGTH, pole);
    rlf_vec3 forward = rlf_neg(pole);
    rlf_vec3 forearm = rlf_normalize(rlf_sub(wrist, elbow));
    rlf_vec3 back = rlf_rotate(body->q, rlf_vec3_make(sign, -0.6 * reach * side, 0.0));
    bones[SYNTH_UPPER_ARM + side] = synth_bone_pose(shoulder, rlf_sub(elbow, shoulder), forward);
    bones[SYNTH_FOREARM + side] = synth_bone_pose(elbow, forearm, forward);
    bones[SYNTH_PALM + side] = synth_bone_pose(wrist, forearm, back);
}

/* Upright on the palm; edge-on to the camera first, then its cover turned to it. */
static void set_book(const synth_figure *figure, double t, rlf_pose *bones)
{
    double now = t - synth_gait_period(RLF_SYNTHETIC_BOOK) *
                         (double)(int64_t)(t / synth_gait_period(RLF_SYNTHETIC_BOOK));
    double turned = synth_smooth((now - BOOK_TURN_BEGIN) / (BOOK_TURN_END - BOOK_TURN_BEGIN));
    rlf_vec3 grip = rlf_transform(&bones[SYNTH_PALM + 1], rlf_vec3_make(0, 0.085 * figure->arm, 0));
    bones[SYNTH_BOOK_BONE].p = grip;
    bones[SYNTH_BOOK_BONE].q =
        rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), 0.5 * RLF_PI * (1.0 + turned));
}

void synth_set_bones(const synth_scene *scene, const synth_figure *figure, const synth_gait *gait,
                     rlf_pose *bones)
{
    rlf_pose body = body_pose(scene, gait);
    set_trunk(figure, &body, gait, bones);
    for (int side = 0; side < 2; side++) {
        set_leg(figure, &body, gait, side, bones);
        set_arm(scene, figure, &body, gait, side, bones);
    }
}

void synth_second_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT])
{
    synth_gait gait = synth_second_gait_at(&scene->second, t);
    synth_set_bones(scene, &scene->second, &gait, bones);
}

void synth_person_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT])
{
    synth_gait gait = synth_gait_at(scene->kind, &scene->person, t);
    synth_set_bones(scene, &scene->person, &gait, bones);
    if (scene->kind == RLF_SYNTHETIC_BOOK) {
        set_book(&scene->person, t, bones);
    }
}
