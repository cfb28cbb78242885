/* How large the room is, and where in it the camera hangs and looks. */
#include "sim/random/plan.h"

#define DEGREES (RLF_PI / 180.0)

/* Mostly nearly level, now and then hung on its side or upside down. */
static double draw_roll(synth_draw *d, bool is_pushed)
{
    const double kind = synth_draw_range(d, 0.0, 1.0);
    const double small = synth_draw_range(d, -4.0, 4.0), large = synth_draw_range(d, -12.0, 12.0);
    if (is_pushed || kind < 0.6) {
        return small * DEGREES;
    }
    if (kind < 0.88) {
        return large * DEGREES;
    }
    return (kind < 0.94 ? 90.0 : 180.0) * DEGREES + small * DEGREES;
}

/* Down at something 1.2 to 3.5 m away, not higher than a chest. */
static double draw_pitch(synth_draw *d, double height)
{
    const double away = synth_draw_range(d, 1.2, 3.5);
    const double target = synth_draw_range(d, 0.1, 1.3);
    const double pitch = rlf_atan2(height - target, away);
    return rlf_clamp(pitch, -5.0 * DEGREES, 60.0 * DEGREES);
}

void synth_draw_camera(synth_plan *plan, bool is_pushed)
{
    synth_draw *d = &plan->draw;
    const double width = synth_draw_range(d, 2.8, 6.5), depth = synth_draw_range(d, 3.0, 6.5);
    plan->height = synth_draw_range(d, 2.35, 3.2);
    plan->floor_y = is_pushed ? synth_draw_range(d, 1.1, 2.0)
                              : synth_draw_range(d, 0.8, rlf_min(2.6, plan->height - 0.2));
    const double x = width * synth_draw_range(d, 0.2, 0.8);
    const double z = synth_draw_range(d, 0.15, rlf_min(1.4, 0.3 * depth));
    plan->room = (synth_plot){-x, width - x, -z, depth - z};
    const double to_middle = rlf_atan2(0.5 * width - x, 0.5 * depth - z);
    const double yaw = to_middle + synth_draw_range(d, -0.3, 0.3);
    const double pitch = draw_pitch(d, plan->floor_y);
    const rlf_quat turn = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), yaw);
    const rlf_quat tilt = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), -pitch);
    const rlf_quat roll = rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), draw_roll(d, is_pushed));
    const rlf_quat q_level_camera = rlf_quat_mul(turn, rlf_quat_mul(tilt, roll));
    plan->random->q_camera_level = rlf_quat_conjugate(q_level_camera);
    plan->scene->floor_y = plan->floor_y;
    plan->scene->down = rlf_rotate(plan->random->q_camera_level, rlf_vec3_make(0, 1, 0));
    plan->wood = synth_look_wood(d);
    plan->cloth = synth_look_cloth(d);
    const double grey = synth_draw_range(d, 0.05, 0.6);
    plan->metal = synth_look_plain(rlf_vec3_make(grey, grey, grey), 0.3, 0.4);
}
