/* The movers of scene "hands" at any time: hands, arms, and who they belong to. */
#include "sim/bones.h"
#include "sim/hands/hands.h"

#define UPPER_ARM 1.68 /* of the hand's length */
#define FOREARM 1.42
#define MOST_PARTS (2 * (SYNTH_HAND_SOLIDS + 2) + 8)

/* Solids in the stage frame. */
typedef struct figures {
    synth_shape shapes[MOST_PARTS];
    const char *names[MOST_PARTS];
    synth_material materials[MOST_PARTS];
    int32_t labels[MOST_PARTS];
    int32_t count;
} figures;

static void add(figures *f, const char *name, int32_t label, synth_material material,
                synth_shape shape)
{
    f->names[f->count] = name;
    f->labels[f->count] = label;
    f->materials[f->count] = material;
    f->shapes[f->count++] = shape;
}

static synth_shape cone(rlf_vec3 a, rlf_vec3 b, double radius_a, double radius_b)
{
    rlf_vec3 way = rlf_sub(b, a);
    synth_shape shape = {.type = SYNTH_CONE, .radius_a = radius_a, .radius_b = radius_b};
    shape.length = rlf_length(way);
    shape.T_camera_shape = synth_bone_pose(a, way, rlf_perpendicular(rlf_normalize(way)));
    return shape;
}

static synth_shape egg(rlf_vec3 at, rlf_vec3 size)
{
    return (synth_shape){
        .type = SYNTH_ELLIPSOID, .T_camera_shape = {at, rlf_quat_identity()}, .size = size};
}

static rlf_vec3 shoulder_of(bool is_left)
{
    return rlf_vec3_make(is_left ? 0.19 : -0.19, -0.43, 0.50);
}

/* From the shoulder, which follows a hand that is out of reach, to the wrist. */
static rlf_vec3 add_arm(figures *f, const synth_hand_form *form, rlf_vec3 wrist)
{
    const double upper = UPPER_ARM * form->length, lower = FOREARM * form->length;
    rlf_vec3 shoulder = shoulder_of(form->is_left), way = rlf_sub(wrist, shoulder);
    const double reach = rlf_length(way), most = 0.97 * (upper + lower);
    rlf_vec3 lean = rlf_scale(way, rlf_max(0.0, reach - most) / reach);
    shoulder = rlf_add(shoulder, lean);
    rlf_vec3 pole = {form->is_left ? 0.7 : -0.7, 0.6, 0.25}, end = wrist;
    rlf_vec3 elbow = synth_bend(shoulder, &end, upper, lower, pole);
    const double s = form->length / 0.18;
    add(f, "upper arm", RLF_SYNTHETIC_LABEL_PERSON, SYNTH_SHIRT,
        cone(shoulder, elbow, 0.055 * s, 0.043 * s));
    add(f, "forearm", RLF_SYNTHETIC_LABEL_HAND, SYNTH_SKIN,
        cone(elbow, wrist, 0.042 * s, 0.027 * s));
    return lean;
}

static void add_hand(figures *f, const synth_track *track, const synth_key *key)
{
    static const char *const names[7] = {"palm", "thumb", "index", "middle", "ring", "little", ""};
    synth_hand_shape hand;
    synth_hand_form_shape(&track->form, &key->grip, &hand);
    for (int i = 0; i < SYNTH_HAND_SOLIDS; i++) {
        synth_shape shape = hand.solids[i];
        int finger = i < SYNTH_HAND_PALM ? 0 : 1 + (i - SYNTH_HAND_PALM) / 3;
        shape.T_camera_shape = rlf_pose_mul(&key->hand, &shape.T_camera_shape);
        add(f, names[finger], RLF_SYNTHETIC_LABEL_HAND, SYNTH_SKIN, shape);
    }
}

static void add_body(figures *f, const synth_hands *hands, rlf_vec3 lean)
{
    rlf_vec3 at = rlf_vec3_make(0.5 * lean.x, 0, 0.54 + 0.5 * rlf_min(0.0, lean.z));
    const int32_t label = RLF_SYNTHETIC_LABEL_PERSON;
    rlf_vec3 left = rlf_add(at, rlf_vec3_make(0.16, -0.44, 0)), right = left;
    right.x -= 0.32;
    add(f, "chest", label, SYNTH_SHIRT,
        egg(rlf_add(at, rlf_vec3_make(0, -0.20, 0.02)), rlf_vec3_make(0.18, 0.34, 0.115)));
    add(f, "shoulders", label, SYNTH_SHIRT, cone(left, right, 0.07, 0.07));
    add(f, "hips", label, SYNTH_TROUSERS,
        egg(rlf_vec3_make(0.5 * at.x, 0.22, 0.56), rlf_vec3_make(0.18, 0.24, 0.13)));
    add(f, "head", label, SYNTH_SKIN,
        egg(rlf_add(at, rlf_vec3_make(0, -0.72, -0.02)), rlf_vec3_make(0.078, 0.115, 0.098)));
    if (hands->track_count == 1) { /* the other arm hangs */
        bool is_left = !hands->tracks[0].form.is_left;
        rlf_vec3 top = shoulder_of(is_left), elbow = top;
        elbow.y += 0.30;
        elbow.x += is_left ? 0.06 : -0.06;
        add(f, "other arm", label, SYNTH_SHIRT, cone(top, elbow, 0.055, 0.042));
        rlf_vec3 wrist = rlf_add(elbow, rlf_vec3_make(0, 0.26, -0.02));
        add(f, "other forearm", label, SYNTH_SHIRT, cone(elbow, wrist, 0.042, 0.03));
    }
}

static void find(const synth_hands *hands, double t, figures *f)
{
    rlf_vec3 lean = {0, 0, 0};
    f->count = 0;
    for (int32_t i = 0; i < hands->track_count; i++) {
        synth_key key = synth_track_at(&hands->tracks[i], t);
        lean = rlf_add(lean, add_arm(f, &hands->tracks[i].form, key.hand.p));
        add_hand(f, &hands->tracks[i], &key);
    }
    add_body(f, hands, lean);
    rlf_vec3 offset = synth_hands_offset(hands, t);
    for (int32_t i = 0; i < f->count; i++) {
        rlf_pose *T = &f->shapes[i].T_camera_shape;
        T->p = rlf_add(T->p, offset);
        *T = rlf_pose_mul(&hands->T_camera_stage, T);
    }
}

rlf_vec3 synth_hands_offset(const synth_hands *hands, double t)
{
    const double span = SYNTH_HANDS_THERE - SYNTH_HANDS_ENTER;
    double away = 1.0 - synth_smooth((t - SYNTH_HANDS_ENTER) / span);
    return rlf_scale(hands->enter, away);
}

void synth_hands_move(synth_scene *scene, double t)
{
    const synth_hands *hands = scene->hands;
    const double h = SYNTH_DIFFERENCE_S;
    figures before, now, after;
    find(hands, t - h, &before);
    find(hands, t, &now);
    find(hands, t + h, &after);
    scene->mover_count = now.count;
    for (int32_t i = 0; i < now.count; i++) {
        synth_part *part = &scene->movers[i];
        const rlf_pose *a = &before.shapes[i].T_camera_shape, *b = &after.shapes[i].T_camera_shape;
        rlf_quat turn = rlf_quat_mul(b->q, rlf_quat_conjugate(a->q));
        *part = (synth_part){.name = now.names[i],
                             .label = now.labels[i],
                             .material = now.materials[i],
                             .shape = now.shapes[i]};
        part->velocity = rlf_scale(rlf_sub(b->p, a->p), 0.5 / h);
        part->angular_velocity =
            rlf_scale(rlf_vec3_make(turn.x, turn.y, turn.z), (turn.w < 0.0 ? -1.0 : 1.0) / h);
    }
}
