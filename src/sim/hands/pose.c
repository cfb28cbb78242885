/* Poses and shapes that all scripts share. */
#include "sim/hands/hands.h"

rlf_quat synth_hands_turn(rlf_vec3 fingers, rlf_vec3 back)
{
    rlf_vec3 y = rlf_normalize(fingers);
    rlf_vec3 x = rlf_normalize(rlf_cross(y, back));
    rlf_vec3 z = rlf_cross(x, y);
    rlf_mat3 m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    return rlf_quat_from_mat3(&m);
}

rlf_pose synth_hands_home(const synth_hands *hands, int32_t track)
{
    double side = hands->tracks[track].form.is_left ? 1.0 : -1.0;
    rlf_pose home = {{0.34 * side, -0.28, 0.38}, rlf_quat_identity()};
    home.q = synth_hands_turn(rlf_vec3_make(-0.2 * side, 0.15, -0.95), rlf_vec3_make(0, -1, 0));
    return home;
}

synth_shape synth_hands_body(const rlf_synthetic_task *task, const rlf_pose *T_body)
{
    synth_shape shape = {.T_camera_shape = *T_body, .size = rlf_scale(task->size, 0.5)};
    shape.type = SYNTH_BOX;
    if (task->body == RLF_SYNTHETIC_BODY_BALL) {
        shape.type = SYNTH_ELLIPSOID;
    } else if (task->body == RLF_SYNTHETIC_BODY_CAN) {
        rlf_vec3 base = {0, -0.5 * task->size.y, 0};
        shape.type = SYNTH_FRUSTUM;
        shape.length = task->size.y;
        shape.radius_a = shape.radius_b = 0.5 * task->size.x;
        shape.T_camera_shape.p = rlf_transform(T_body, base);
    }
    return shape;
}
