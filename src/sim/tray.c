/* A flat tray on an arm that lifts and carries, or, upright, sweeps along the floor. */
#include "sim/bones.h"
#include "sim/gait.h"

#define ENTER_BEGIN 0.4 /* s; out of view before */
#define ENTER_END 1.4
#define START 3.0 /* s; from here on at the scene's speed */
#define RISE 0.4  /* metres */
#define SWEEP_BEGIN (-0.6)
#define SWEEP_END 0.5
#define BOARD_YAW 0.35 /* radians; the pushing side is turned to the camera */
#define CIRCLE 0.25    /* metres, radius */
#define RAMP 0.4       /* s; in which the tray reaches its speed along the circle */

/* The tray's half extents are x, z along it and y through it; the arm leaves along its +x,
 * below. */
const synth_flesh synth_tray_flesh[2] = {
    {"tray", SYNTH_BOOK_BONE, SYNTH_BOOK, SYNTH_BOX, {0, 0, 0}, 'y', {0.25, 0.012, 0.2}, 0, 0, 0},
    {"arm",
     SYNTH_BOOK_BONE,
     SYNTH_SKIN,
     SYNTH_CONE,
     {0.2, 0.05, 0},
     'x',
     {0, 0, 0},
     0.75,
     0.035,
     0.05},
};

static rlf_vec3 lift_at(double t, double speed)
{
    double risen = rlf_clamp((t - START) * speed, 0.0, RISE);
    return rlf_vec3_make(0.0, 0.75 - risen, 1.5);
}

/* Speeds up evenly during RAMP, so s = v t^2 / (2 RAMP), then v (t - RAMP / 2). */
static rlf_vec3 carry_at(double t, double speed)
{
    double tau = rlf_max(0.0, t - START);
    double way = tau < RAMP ? 0.5 * tau * tau / RAMP : tau - 0.5 * RAMP;
    double angle = speed * way / CIRCLE;
    return rlf_vec3_make(CIRCLE * (rlf_cos(angle) - 1.0), 0.6 + 0.05 * rlf_sin(angle),
                         1.6 + CIRCLE * rlf_sin(angle));
}

static rlf_vec3 sweep_at(double t, double speed, double floor_y)
{
    double x = SWEEP_BEGIN + rlf_clamp((t - START) * speed, 0.0, SWEEP_END - SWEEP_BEGIN);
    return rlf_vec3_make(x, floor_y - 0.26, 2.8);
}

void synth_tray_bones(const synth_scene *scene, double t, rlf_pose bones[SYNTH_BONE_COUNT])
{
    double outside = 2.6 * (1.0 - synth_smooth((t - ENTER_BEGIN) / (ENTER_END - ENTER_BEGIN)));
    rlf_pose *tray = &bones[SYNTH_BOOK_BONE];
    tray->q = rlf_quat_identity();
    if (scene->kind == RLF_SYNTHETIC_SWIPE) {
        tray->p = sweep_at(t, scene->speed, scene->floor_y);
        tray->p.x -= outside;
        /* on end, its top turned to +x and a little to the camera; the arm comes from above */
        rlf_quat over = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), RLF_PI);
        rlf_quat up = rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), -0.5 * RLF_PI);
        rlf_quat yaw = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), BOARD_YAW);
        tray->q = rlf_quat_mul(yaw, rlf_quat_mul(up, over));
        return;
    }
    tray->p =
        scene->kind == RLF_SYNTHETIC_LIFT ? lift_at(t, scene->speed) : carry_at(t, scene->speed);
    tray->p.x += outside;
}
