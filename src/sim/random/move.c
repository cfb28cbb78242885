/* Who and what moves in a random room. */
#include "sim/bones.h"
#include "sim/random/plan.h"

#define RAMP 0.4 /* s in which a tray reaches its speed along the circle */

static rlf_vec3 carry_at(const synth_moved *m, double tau)
{
    const double way = tau < RAMP ? 0.5 * tau * tau / RAMP : tau - 0.5 * RAMP;
    const double angle = m->speed * way / SYNTH_CIRCLE;
    const rlf_vec3 along = rlf_scale(m->along, SYNTH_CIRCLE * (rlf_cos(angle) - 1.0));
    return rlf_mad(along, m->aside, SYNTH_CIRCLE * rlf_sin(angle));
}

/* How far it is from its place at time t, camera frame. */
static rlf_vec3 offset_at(const synth_moved *m, double t)
{
    const double tau = rlf_max(0.0, t - m->start);
    switch (m->push) {
    case RLF_SYNTHETIC_PUSH_SWIPE:
        return rlf_scale(m->along, rlf_min(m->speed * tau, SYNTH_SWEEP_WAY));
    case RLF_SYNTHETIC_PUSH_CARRY: return carry_at(m, tau);
    default: return rlf_scale(m->up, rlf_min(m->speed * tau, m->rise));
    }
}

/* Bones of a person, camera frame. */
static void find_bones(const synth_scene *scene, const synth_individual *person, double t,
                       rlf_pose *bones)
{
    synth_script script = person->script;
    script.acts = person->acts;
    const synth_gait gait = synth_gait_follow(&script, &person->figure, t);
    const rlf_pose T_camera_level = {{0, 0, 0}, scene->random->q_camera_level};
    const rlf_pose T = rlf_pose_mul(&T_camera_level, &person->T_level_path);
    synth_set_bones(scene, &person->figure, &gait, bones);
    for (int32_t i = 0; i < SYNTH_BOOK_BONE; i++) {
        bones[i] = rlf_pose_mul(&T, &bones[i]);
    }
}

static void move_person(synth_scene *scene, const synth_individual *person, double t)
{
    synth_motion m;
    find_bones(scene, person, t - SYNTH_DIFFERENCE_S, m.before);
    find_bones(scene, person, t, m.now);
    find_bones(scene, person, t + SYNTH_DIFFERENCE_S, m.after);
    for (int32_t i = 0; i < person->flesh_count; i++) {
        const synth_flesh *flesh = &person->flesh[i];
        synth_put_flesh(scene, flesh, person->label, &m);
        synth_part *part = &scene->movers[scene->mover_count - 1];
        part->look = person->looks[flesh->material];
        part->material = flesh->material == SYNTH_FACE ? SYNTH_FACE : SYNTH_DRAWN;
    }
}

static void move_thing(synth_scene *scene, double t)
{
    const synth_moved *m = &scene->random->moved;
    if (m->part_count == 0 || m->is_gone || t < m->start) {
        return;
    }
    const double h = SYNTH_DIFFERENCE_S;
    const rlf_vec3 offset = offset_at(m, t);
    const rlf_vec3 way = rlf_sub(offset_at(m, t + h), offset_at(m, t - h));
    for (int32_t i = 0; i < m->part_count; i++) {
        synth_part *part = &scene->movers[scene->mover_count++];
        *part = m->parts[i];
        part->velocity = rlf_scale(way, 0.5 / h);
        part->shape.T_camera_shape.p = rlf_add(part->shape.T_camera_shape.p, offset);
    }
}

void synth_random_move(synth_scene *scene, double t)
{
    scene->mover_count = 0;
    for (int32_t i = 0; i < scene->random->people_count; i++) {
        move_person(scene, &scene->random->people[i], t);
    }
    move_thing(scene, t);
}
