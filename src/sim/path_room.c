/* The rest of the room about a camera that moves: a camera at rest sees one wall, floor and
 * ceiling. */
#include "sim/path.h"

static synth_part *add(synth_scene *scene, int32_t label, synth_material material, const char *name)
{
    synth_part *part = &scene->statics[scene->static_count++];
    *part = (synth_part){.name = name, .label = label, .material = material};
    part->shape.T_camera_shape = rlf_pose_identity();
    return part;
}

/* Solid beyond p: the wall ahead, turned about the vertical. */
static void add_wall(synth_scene *scene, rlf_vec3 p, double yaw)
{
    synth_part *part = add(scene, RLF_SYNTHETIC_LABEL_WALL, SYNTH_WALL, "wall");
    const rlf_quat ahead = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), 0.5 * RLF_PI);
    const rlf_quat turn = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), yaw);
    part->shape.type = SYNTH_HALF_SPACE;
    part->shape.T_camera_shape.p = p;
    part->shape.T_camera_shape.q = rlf_quat_mul(turn, ahead);
}

/* A box on the floor, its middle at x, z. */
static void add_block(synth_scene *scene, synth_material material, double x, double z,
                      rlf_vec3 size)
{
    synth_part *part = add(scene, RLF_SYNTHETIC_LABEL_CUPBOARD, material, "cupboard");
    part->shape.type = SYNTH_BOX;
    part->shape.size = rlf_scale(size, 0.5);
    part->shape.T_camera_shape.p = rlf_vec3_make(x, scene->floor_y - 0.5 * size.y, z);
}

void synth_path_close_room(synth_scene *scene)
{
    const int32_t first_taken = scene->static_count - scene->removed_count;
    synth_part taken[16];
    const int32_t taken_count = scene->removed_count < 16 ? scene->removed_count : 16;
    for (int32_t i = 0; i < taken_count; i++) {
        taken[i] = scene->statics[first_taken + i];
    }
    scene->static_count = first_taken;
    add_wall(scene, rlf_vec3_make(3.0, 0, 0), 0.5 * RLF_PI);
    add_wall(scene, rlf_vec3_make(-3.2, 0, 0), -0.5 * RLF_PI);
    add_wall(scene, rlf_vec3_make(0, 0, -1.6), RLF_PI);
    add_block(scene, SYNTH_CUPBOARD, 2.8, 0.6, rlf_vec3_make(0.4, 1.6, 0.8));
    add_block(scene, SYNTH_CARDBOARD, 2.5, -0.4, rlf_vec3_make(0.5, 0.5, 0.4));
    add_block(scene, SYNTH_TABLE, -2.9, 0.9, rlf_vec3_make(0.5, 0.8, 1.1));
    add_block(scene, SYNTH_BOX_TEAL, -2.8, 1.1, rlf_vec3_make(0.3, 1.1, 0.3));
    add_block(scene, SYNTH_CUPBOARD, 0.5, -1.4, rlf_vec3_make(1.0, 1.9, 0.4));
    add_block(scene, SYNTH_BOX_RED, -0.9, -1.3, rlf_vec3_make(0.5, 0.6, 0.5));
    for (int32_t i = 0; i < taken_count; i++) {
        scene->statics[scene->static_count++] = taken[i]; /* last, as before */
    }
    synth_scene_bound(scene);
}
