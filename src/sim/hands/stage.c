/* The table, the camera and the choice of the script. */
#include "sim/hands/hands.h"
#include "sim/hash.h"

#define DEGREE (RLF_PI / 180.0)
#define FLOOR 0.75     /* metres under the table's top */
#define WALL_AWAY 1.15 /* metres behind the middle, as the camera looks */
#define COME_FROM 2.7  /* metres aside */
#define HEIGHT 0.10    /* of the middle of the action over the table */
#define TABLE_MIDDLE 0.02
#define LEAST_LENGTH 0.160 /* of hands: 5th percentile of women to 95th of men, ANSUR II */
#define MOST_LENGTH 0.205

static synth_part *add(synth_scene *scene, const synth_hands *hands, int32_t label,
                       synth_material material, rlf_pose at)
{
    synth_part *part = &scene->statics[scene->static_count++];
    part->name = label == RLF_SYNTHETIC_LABEL_TABLE ? "table" : "room";
    part->label = label;
    part->material = material;
    part->shape.T_camera_shape = rlf_pose_mul(&hands->T_camera_stage, &at);
    return part;
}

/* `forwards` is level, from the camera to the middle. */
static void add_room(synth_scene *scene, const synth_hands *hands, rlf_vec3 forwards)
{
    const rlf_pose floor = {{0, FLOOR, 0}, rlf_quat_identity()};
    rlf_pose wall = {rlf_scale(forwards, WALL_AWAY), rlf_quat_identity()};
    double yaw = rlf_atan2(forwards.x, forwards.z);
    wall.q = rlf_quat_mul(rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), yaw),
                          rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), 0.5 * RLF_PI));
    const rlf_pose table = {{0, 0.015, TABLE_MIDDLE}, rlf_quat_identity()};
    add(scene, hands, RLF_SYNTHETIC_LABEL_FLOOR, SYNTH_FLOOR, floor)->shape.type = SYNTH_HALF_SPACE;
    add(scene, hands, RLF_SYNTHETIC_LABEL_WALL, SYNTH_WALL, wall)->shape.type = SYNTH_HALF_SPACE;
    synth_part *top = add(scene, hands, RLF_SYNTHETIC_LABEL_TABLE, SYNTH_TABLE, table);
    top->shape.type = SYNTH_BOX;
    top->shape.size = rlf_vec3_make(0.70, 0.015, 0.36);
    for (int i = 0; i < 4; i++) {
        rlf_pose leg = {{i & 1 ? 0.62 : -0.62, 0.39, TABLE_MIDDLE + (i & 2 ? 0.3 : -0.3)},
                        rlf_quat_identity()};
        synth_part *part = add(scene, hands, RLF_SYNTHETIC_LABEL_TABLE, SYNTH_TABLE, leg);
        part->shape.type = SYNTH_BOX;
        part->shape.size = rlf_vec3_make(0.025, 0.36, 0.025);
    }
}

/* Places the camera; returns the level direction in which it looks. */
static rlf_vec3 place_camera(synth_hands *hands, synth_draw *d)
{
    const rlf_synthetic_view view = hands->def.view;
    double turn = synth_draw_chance(d, 0.5) ? 1.0 : -1.0;
    double yaw = synth_draw_range(d, -25.0, 25.0), pitch = synth_draw_range(d, 15.0, 30.0);
    if (view == RLF_SYNTHETIC_VIEW_ABOVE) {
        pitch = synth_draw_range(d, 60.0, 78.0);
    } else if (view == RLF_SYNTHETIC_VIEW_SIDE) {
        yaw = turn * synth_draw_range(d, 55.0, 80.0);
        pitch = synth_draw_range(d, 10.0, 30.0);
    }
    yaw *= DEGREE;
    pitch *= DEGREE;
    rlf_vec3 level = {rlf_sin(yaw), 0, rlf_cos(yaw)};
    rlf_vec3 z = {rlf_cos(pitch) * level.x, rlf_sin(pitch), rlf_cos(pitch) * level.z};
    rlf_vec3 x = rlf_normalize(rlf_cross(rlf_vec3_make(0, 1, 0), z));
    rlf_vec3 y = rlf_cross(z, x);
    rlf_mat3 m = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    rlf_pose T_stage_camera = {rlf_mad(hands->centre, z, -hands->def.distance),
                               rlf_quat_from_mat3(&m)};
    hands->T_camera_stage = rlf_pose_invert(&T_stage_camera);
    hands->across = x;
    /* from behind the table, over which nobody walks */
    hands->enter = rlf_scale(x, x.z < 0.0 ? -COME_FROM : COME_FROM);
    return level;
}

static void add_tracks(synth_hands *hands, synth_draw *d)
{
    const bool is_left = synth_draw_chance(d, 0.5);
    const double length = synth_draw_range(d, LEAST_LENGTH, MOST_LENGTH);
    hands->track_count = hands->def.act == RLF_SYNTHETIC_ACT_TWO_HANDS ? 2 : 1;
    for (int32_t i = 0; i < hands->track_count; i++) {
        hands->tracks[i] = (synth_track){.form = {length, i == 0 ? is_left : !is_left}};
    }
}

void synth_hands_build(synth_scene *scene, synth_hands *hands, const rlf_synthetic_def *def)
{
    synth_draw d = synth_draw_start(def->seed, 77);
    *hands = (synth_hands){.def = def->hands, .speed = def->speed, .centre = {0, -HEIGHT, 0}};
    rlf_vec3 forwards = place_camera(hands, &d);
    *scene = (synth_scene){.kind = RLF_SYNTHETIC_HANDS, .speed = def->speed, .hands = hands};
    scene->down = rlf_rotate(hands->T_camera_stage.q, rlf_vec3_make(0, 1, 0));
    scene->q_camera_level = &hands->T_camera_stage.q;
    scene->floor_y = rlf_dot(scene->down, hands->T_camera_stage.p) + FLOOR;
    scene->lamp = rlf_transform(&hands->T_camera_stage, rlf_vec3_make(-0.6, -1.5, -0.4));
    add_room(scene, hands, forwards);
    synth_scene_bound(scene);
    add_tracks(hands, &d);
    if (def->hands.act == RLF_SYNTHETIC_ACT_PASS) {
        synth_hands_script_pass(hands, &d);
    } else if (def->hands.act < RLF_SYNTHETIC_ACT_PASS) {
        synth_hands_script_grasp(hands, &d);
    } else {
        synth_hands_script_gesture(hands, &d);
    }
    synth_hands_move(scene, 0.0);
}
