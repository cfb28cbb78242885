/* Who moves in which scene. */
#include "sim/bones.h"
#include "sim/hands/hands.h"
#include "sim/random/plan.h"

typedef void (*bones_fn)(const synth_scene *, double, rlf_pose[SYNTH_BONE_COUNT]);

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
    if (scene->hands != NULL) {
        synth_hands_move(scene, t);
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
