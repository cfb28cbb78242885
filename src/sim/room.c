/* The room: shell and furniture, in metres. Heights are above the floor, x and z in the camera
 * frame. */
#include "sim/scene.h"

static const char *const label_names[] = {
    "",          "wall",    "floor", "ceiling", "column", "cupboard", "table", "box large",
    "box small", "box top", "ball",  "chair",   "person", "book",     "hand",  "tray",
};

static synth_part *add(synth_scene *scene, int32_t label, synth_material material)
{
    synth_part *part = &scene->statics[scene->static_count++];
    part->shape.T_camera_shape = rlf_pose_identity();
    part->name = label_names[label];
    part->label = label;
    part->material = material;
    return part;
}

/* Solid beyond the plane through p; `rotation` about x turns "below" (+y) into "behind". */
static void add_half_space(synth_scene *scene, int32_t label, rlf_vec3 p, double rotation)
{
    static const synth_material materials[] = {SYNTH_WALL, SYNTH_WALL, SYNTH_FLOOR, SYNTH_CEILING};
    synth_part *part = add(scene, label, materials[label]);
    part->shape.type = SYNTH_HALF_SPACE;
    part->shape.T_camera_shape.p = p;
    part->shape.T_camera_shape.q = rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), rotation);
}

/* A box that stands `base` above the floor; x, z are of its centre, size is width, height, depth.
 */
typedef struct block {
    double x, base, z;
    double width, height, depth;
    double yaw; /* radians about the vertical */
} block;

static void add_block(synth_scene *scene, int32_t label, synth_material material, block b)
{
    synth_part *part = add(scene, label, material);
    part->shape.type = SYNTH_BOX;
    part->shape.size = rlf_vec3_make(0.5 * b.width, 0.5 * b.height, 0.5 * b.depth);
    part->shape.T_camera_shape.p =
        rlf_vec3_make(b.x, scene->floor_y - b.base - 0.5 * b.height, b.z);
    part->shape.T_camera_shape.q = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), b.yaw);
}

/* Four legs under a rectangle of the given width and depth. */
static void add_legs(synth_scene *scene, int32_t label, synth_material material, block top)
{
    const double side = 0.045;
    for (int i = 0; i < 4; i++) {
        block leg = top;
        leg.x += ((i & 1) != 0 ? 0.5 : -0.5) * (top.width - 1.6 * side);
        leg.z += ((i & 2) != 0 ? 0.5 : -0.5) * (top.depth - 1.6 * side);
        leg.base = 0.0;
        leg.height = top.base;
        leg.width = side;
        leg.depth = side;
        add_block(scene, label, material, leg);
    }
}

static void add_table(synth_scene *scene)
{
    const block top = {1.12, 0.70, 2.36, 1.06, 0.035, 0.56, 0.0};
    const double surface = top.base + top.height;
    add_block(scene, RLF_SYNTHETIC_LABEL_TABLE, SYNTH_TABLE, top);
    add_legs(scene, RLF_SYNTHETIC_LABEL_TABLE, SYNTH_TABLE, top);
    add_block(scene, RLF_SYNTHETIC_LABEL_BOX_LARGE, SYNTH_CARDBOARD,
              (block){1.34, surface, 2.40, 0.34, 0.22, 0.26, 0.35});
    add_block(scene, RLF_SYNTHETIC_LABEL_BOX_TOP, SYNTH_BOX_RED,
              (block){1.36, surface + 0.22, 2.41, 0.20, 0.11, 0.15, -0.25});
    add_block(scene, RLF_SYNTHETIC_LABEL_BOX_SMALL, SYNTH_BOX_TEAL,
              (block){0.84, surface, 2.34, 0.16, 0.16, 0.16, -0.5});
}

static void add_ball(synth_scene *scene)
{
    const double radius = 0.14;
    synth_part *ball = add(scene, RLF_SYNTHETIC_LABEL_BALL, SYNTH_BALL);
    ball->shape.type = SYNTH_ELLIPSOID;
    ball->shape.size = rlf_vec3_make(radius, radius, radius);
    ball->shape.T_camera_shape.p = rlf_vec3_make(0.48, scene->floor_y - radius, 3.42);
    ball->shape.T_camera_shape.q = rlf_quat_from_rotation_vector(rlf_vec3_make(0.9, 0.3, 0.5));
}

/* Last in the list: it is what scene "chair" takes away. */
static void add_chair(synth_scene *scene)
{
    const int32_t first = scene->static_count;
    const block seat = {-1.12, 0.43, 3.42, 0.42, 0.035, 0.42, 0.0};
    const int32_t label = RLF_SYNTHETIC_LABEL_CHAIR;
    add_block(scene, label, SYNTH_CHAIR, seat);
    add_legs(scene, label, SYNTH_CHAIR, seat);
    for (int i = 0; i < 2; i++) {
        double x = seat.x + (i == 0 ? -0.174 : 0.174);
        add_block(scene, label, SYNTH_CHAIR,
                  (block){x, 0.465, seat.z + 0.174, 0.045, 0.45, 0.045, 0.0});
        add_block(scene, label, SYNTH_CHAIR,
                  (block){seat.x, 0.60 + 0.20 * i, seat.z + 0.174, 0.35, 0.11, 0.02, 0.0});
    }
    scene->removed_count = scene->kind == RLF_SYNTHETIC_CHAIR ? scene->static_count - first : 0;
}

static void add_shell(synth_scene *scene, double wall_z)
{
    add_half_space(scene, RLF_SYNTHETIC_LABEL_WALL, rlf_vec3_make(0, 0, wall_z), 0.5 * RLF_PI);
    add_half_space(scene, RLF_SYNTHETIC_LABEL_FLOOR, rlf_vec3_make(0, scene->floor_y, 0), 0.0);
}

static void build_thesis(synth_scene *scene)
{
    scene->floor_y = 1.25;
    add_shell(scene, 3.2);
    scene->statics[scene->static_count - 1].material = SYNTH_TILES;
    add_block(scene, RLF_SYNTHETIC_LABEL_WALL, SYNTH_RUBBER,
              (block){0.0, 0.0, 3.2, 20.0, 0.10, 0.02, 0.0});
    add_block(scene, RLF_SYNTHETIC_LABEL_COLUMN, SYNTH_COLUMN,
              (block){0.99, 0.0, 3.05, 0.4, 4.0, 0.3, 0.0});
}

static void build_bare(synth_scene *scene)
{
    scene->floor_y = 1.3;
    add_shell(scene, 3.9);
    add_half_space(scene, RLF_SYNTHETIC_LABEL_CEILING, rlf_vec3_make(0, -1.4, 0), RLF_PI);
}

static void build_room(synth_scene *scene)
{
    build_bare(scene);
    add_block(scene, RLF_SYNTHETIC_LABEL_COLUMN, SYNTH_COLUMN,
              (block){1.05, 0.0, 3.75, 0.38, 2.7, 0.3, 0.0});
    add_block(scene, RLF_SYNTHETIC_LABEL_CUPBOARD, SYNTH_CUPBOARD,
              (block){-2.02, 0.0, 3.675, 0.9, 1.95, 0.45, 0.0});
    add_table(scene);
    add_ball(scene);
    add_chair(scene);
}

void synth_scene_bound(synth_scene *scene)
{
    for (int32_t i = 0; i < scene->static_count; i++) {
        synth_ball *ball = &scene->bounds[i];
        ball->radius = synth_shape_bound(&scene->statics[i].shape, &ball->centre);
    }
}

void synth_scene_build(synth_scene *scene, rlf_synthetic_scene kind)
{
    *scene = (synth_scene){
        .kind = kind, .speed = 0.5, .lamp = {-0.70, -1.85, 1.5}, .down = {0.0, 1.0, 0.0}};
    if (kind == RLF_SYNTHETIC_THESIS) {
        build_thesis(scene);
    } else if (synth_has_tray(kind) || kind == RLF_SYNTHETIC_CROSSING) {
        build_bare(scene);
    } else {
        build_room(scene);
    }
    synth_scene_bound(scene);
    scene->removal_time = kind == RLF_SYNTHETIC_CHAIR ? 4.0 : 0.0;
    synth_scene_set_people(scene, 1);
}

void synth_scene_set_people(synth_scene *scene, uint64_t seed)
{
    synth_figure_make(&scene->person, seed, false);
    synth_figure_make(&scene->second, seed, true);
    synth_scene_move(scene, 0.0);
}

int32_t synth_scene_static_count(const synth_scene *scene, double t)
{
    bool is_removed = scene->removed_count > 0 && t >= scene->removal_time;
    return scene->static_count - (is_removed ? scene->removed_count : 0);
}

const synth_part *synth_nearest(const synth_part *parts, int32_t count, rlf_vec3 p,
                                double *out_distance, rlf_vec3 *out_normal)
{
    const synth_part *nearest = NULL;
    *out_distance = 1e9;
    *out_normal = rlf_vec3_make(0, 0, 0);
    for (int32_t i = 0; i < count; i++) {
        rlf_vec3 normal, centre;
        const double radius = synth_shape_bound(&parts[i].shape, &centre);
        if (rlf_length(rlf_sub(p, centre)) - radius >= *out_distance) {
            continue; /* the ball about it is farther already */
        }
        double distance = synth_shape_distance(&parts[i].shape, p, &normal);
        if (distance < *out_distance) {
            *out_distance = distance;
            *out_normal = normal;
            nearest = &parts[i];
        }
    }
    return nearest;
}
