/* Puts the solids on the bones, with the velocity of their rigid motion. */
#include "sim/bones.h"

static rlf_pose pose_on_bone(const rlf_pose *bone, const synth_flesh *flesh)
{
    /* Turns the shape's y axis into the bone's x or z axis. */
    rlf_pose local = {flesh->offset, rlf_quat_identity()};
    if (flesh->axis == 'x') {
        local.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 0, 1), -0.5 * RLF_PI);
    } else if (flesh->axis == 'z') {
        local.q = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), 0.5 * RLF_PI);
    }
    return rlf_pose_mul(bone, &local);
}

void synth_put_flesh(synth_scene *scene, const synth_flesh *flesh, int32_t label,
                     const synth_motion *m)
{
    synth_part *part = &scene->movers[scene->mover_count++];
    rlf_pose before = pose_on_bone(&m->before[flesh->bone], flesh);
    rlf_pose after = pose_on_bone(&m->after[flesh->bone], flesh);
    rlf_quat turn = rlf_quat_mul(after.q, rlf_quat_conjugate(before.q));
    double rate = (turn.w < 0.0 ? -2.0 : 2.0) / (2.0 * SYNTH_DIFFERENCE_S);
    *part = (synth_part){.name = flesh->name, .label = label, .material = flesh->material};
    part->shape.type = flesh->type;
    part->shape.size = flesh->size;
    part->shape.length = flesh->length;
    part->shape.radius_a = flesh->radius_a;
    part->shape.radius_b = flesh->radius_b;
    part->shape.T_camera_shape = pose_on_bone(&m->now[flesh->bone], flesh);
    part->velocity = rlf_scale(rlf_sub(after.p, before.p), 1.0 / (2.0 * SYNTH_DIFFERENCE_S));
    part->angular_velocity = rlf_scale(rlf_vec3_make(turn.x, turn.y, turn.z), rate);
}
