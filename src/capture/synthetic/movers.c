/* Puts the solids on the bones, with the velocity of their rigid motion. */
#include "capture/synthetic/bones.h"
#include "capture/synthetic/random/random.h"

typedef void (*bones_fn)(const synth_scene *, double, rlf_pose[SYNTH_BONE_COUNT]);

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

rlf_vec3 synth_part_velocity(const synth_part *part, rlf_vec3 p)
{
    rlf_vec3 arm = rlf_sub(p, part->shape.T_camera_shape.p);
    return rlf_add(part->velocity, rlf_cross(part->angular_velocity, arm));
}

static synth_motion motion_at(const synth_scene *scene, bones_fn bones, double t)
{
    synth_motion m;
    bones(scene, t - SYNTH_DIFFERENCE_S, m.before);
    bones(scene, t, m.now);
    bones(scene, t + SYNTH_DIFFERENCE_S, m.after);
    return m;
}

static void move_tray(synth_scene *scene, double t)
{
    synth_motion m = motion_at(scene, synth_tray_bones, t);
    synth_put_flesh(scene, &synth_tray_flesh[0], RLF_SYNTHETIC_LABEL_TRAY, &m);
    synth_put_flesh(scene, &synth_tray_flesh[1], RLF_SYNTHETIC_LABEL_HAND, &m);
}

static void move_hand(synth_scene *scene, double t)
{
    synth_motion m = motion_at(scene, synth_hand_bones, t);
    for (int32_t i = 0; i < synth_hand_flesh_count; i++) {
        synth_put_flesh(scene, &synth_hand_flesh[i], RLF_SYNTHETIC_LABEL_HAND, &m);
    }
}

static void move_person(synth_scene *scene, const synth_figure *figure, bones_fn bones,
                        int32_t label, double t)
{
    synth_motion m = motion_at(scene, bones, t);
    for (int32_t i = 0; i < SYNTH_PERSON_FLESH; i++) {
        synth_put_flesh(scene, &figure->flesh[i], label, &m);
    }
    if (scene->kind == RLF_SYNTHETIC_BOOK) {
        synth_put_flesh(scene, &synth_book_flesh, RLF_SYNTHETIC_LABEL_BOOK, &m);
    }
}

void synth_scene_move(synth_scene *scene, double t)
{
    scene->mover_count = 0;
    if (scene->random != NULL) {
        synth_random_move(scene, t);
        return;
    }
    if (scene->kind == RLF_SYNTHETIC_EMPTY) {
        return;
    }
    if (synth_has_tray(scene->kind)) {
        move_tray(scene, t);
    } else if (scene->kind == RLF_SYNTHETIC_HAND) {
        move_hand(scene, t);
    } else {
        move_person(scene, &scene->person, synth_person_bones, RLF_SYNTHETIC_LABEL_PERSON, t);
    }
    if (scene->kind == RLF_SYNTHETIC_CROSSING) {
        move_person(scene, &scene->second, synth_second_bones, RLF_SYNTHETIC_LABEL_SECOND_PERSON,
                    t);
    }
}
