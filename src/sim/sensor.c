/* rlf_synthetic_create: the sensor's cameras, its frames and its truth. */
#include "sim/sensor.h"
#include "base/checks.h"

#include <stdio.h>
#include <string.h>

#define GRAVITY_M_S2 9.81
#define KINECT_F 365.5        /* depth camera of the Kinect v2, pixels */
#define KINECT_COLOR_F 1081.0 /* colour camera, pixels at 1920 x 1080 */
#define KINECT_BASELINE 0.052 /* metres from the depth camera to the colour camera, along +x */

/* Nominal intrinsics without distortion; the principal point is the middle of the picture. */
static rlf_rig make_rig(const rlf_synthetic_def *def)
{
    rlf_rig rig = {.T_color_depth = rlf_pose_identity(),
                   .has_color = def->enable_color,
                   .depth_min_m = 0.5,
                   .depth_max_m = 4.5,
                   /* 1.5 - 0.5 z + 0.3 z^2 mm: Fankhauser et al. 2015 for frontal surfaces */
                   .noise = {0.0015, -0.0005, 0.0003}};
    if (def->enable_structured_light) {
        rig.noise = rlf_rig_default().noise; /* as measured of a Kinect v1 */
    }
    rig.depth = (rlf_camera){.width = SYNTH_DEPTH_WIDTH,
                             .height = SYNTH_DEPTH_HEIGHT,
                             .fx = KINECT_F,
                             .fy = KINECT_F,
                             .cx = 0.5 * (SYNTH_DEPTH_WIDTH - 1),
                             .cy = 0.5 * (SYNTH_DEPTH_HEIGHT - 1)};
    if (def->enable_color) {
        double f = KINECT_COLOR_F * def->color_width / 1920.0;
        rig.color = (rlf_camera){.width = def->color_width,
                                 .height = def->color_height,
                                 .fx = f,
                                 .fy = f,
                                 .cx = 0.5 * (def->color_width - 1),
                                 .cy = 0.5 * (def->color_height - 1)};
        rig.T_color_depth.p.x = -KINECT_BASELINE;
    }
    return rig;
}

/* What was drawn of the sensor in place of the Kinect's. */
static void set_drawn(rlf_rig *rig, const synth_random *random)
{
    const double scale = random->focal / KINECT_F;
    rig->depth.fx = rig->depth.fy = random->focal;
    rig->color.fx *= scale;
    rig->color.fy *= scale;
    rig->depth_min_m = random->min_m;
    rig->depth_max_m = random->max_m;
    rig->noise = random->sigma;
}

static void sensor_destroy(void *self)
{
    synth_sensor *sensor = self;
    synth_depth_destroy(&sensor->depth);
    synth_color_destroy(&sensor->color);
    rlf_free(sensor);
}

static void add_poses(synth_sensor *sensor, const synth_part *parts, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        rlf_truth_pose *pose = &sensor->poses[sensor->truth.pose_count++];
        (void)snprintf(pose->name, sizeof(pose->name), "%s", parts[i].name);
        pose->label = parts[i].label;
        pose->T_camera_object = parts[i].shape.T_camera_shape;
    }
}

static void fill_truth(synth_sensor *sensor)
{
    synth_depth *depth = &sensor->depth;
    rlf_truth *truth = &sensor->truth;
    synth_depth_find_truth(depth);
    truth->depth = depth->now.z;
    truth->normal_x = depth->now.normal[0];
    truth->normal_y = depth->now.normal[1];
    truth->normal_z = depth->now.normal[2];
    truth->label = depth->now.label;
    truth->foreground = depth->foreground;
    truth->thickness = depth->now.thickness;
    truth->velocity_x = depth->velocity[0];
    truth->velocity_y = depth->velocity[1];
    truth->velocity_z = depth->velocity[2];
    truth->background_depth = depth->room[depth->room_index].z;
    truth->poses = sensor->poses;
    truth->pose_count = 0;
    add_poses(sensor, sensor->scene.movers, sensor->scene.mover_count);
    if (sensor->scene.random != NULL && sensor->time < sensor->random.moved.start) {
        add_poses(sensor, sensor->random.moved.parts, sensor->random.moved.part_count);
    }
}

void synth_sensor_see(synth_sensor *sensor, double t, synth_scene *scene)
{
    if (sensor->path.kind == RLF_SYNTHETIC_PATH_NONE) {
        synth_scene_move(scene, t);
        return;
    }
    const rlf_pose pose = synth_path_pose(&sensor->path, t);
    synth_scene_move(&sensor->rest, t);
    synth_path_see(&sensor->rest, &pose, scene);
}

/* The scene at a frame's time, and what of the pictures a camera that moves must cast anew. */
static void move_to(synth_sensor *sensor, double t)
{
    sensor->time = t;
    synth_sensor_see(sensor, t, &sensor->scene);
    const synth_scene *scene = &sensor->scene;
    const int32_t state = synth_scene_static_count(scene, t) < scene->static_count ? 1 : 0;
    if (scene->is_moving) {
        sensor->T_world_camera = synth_path_pose(&sensor->path, t);
        synth_depth_cast_room(&sensor->depth, state);
        if (sensor->def.enable_color) {
            synth_color_cast_room(&sensor->color, state);
        }
    }
}

static rlf_result sensor_next(void *self, rlf_frame *out)
{
    synth_sensor *sensor = self;
    const rlf_synthetic_def *def = &sensor->def;
    if (sensor->next_frame >= (def->frame_count < 0 ? SYNTH_FRAME_COUNT_MAX : def->frame_count)) {
        return RLF_END;
    }
    int64_t frame = sensor->next_frame++;
    move_to(sensor, (double)frame / def->frames_per_second);
    sensor->has_frame = true;
    bool is_removed =
        synth_scene_static_count(&sensor->scene, sensor->time) < sensor->scene.static_count;
    synth_depth_render(&sensor->depth, (uint32_t)frame, is_removed ? 1 : 0);
    if (def->enable_color) {
        if (frame > 0) {
            synth_color_sharpen(&sensor->color);
        }
        synth_color_render(&sensor->color, is_removed ? 1 : 0);
        out->color = (rlf_image_rgba8){.data = sensor->color.out,
                                       .width = def->color_width,
                                       .height = def->color_height,
                                       .stride = 4 * (ptrdiff_t)def->color_width};
    }
    out->sequence = (uint64_t)frame;
    out->time_ns = (int64_t)(sensor->time * 1e9 + 0.5);
    out->depth_u16 = sensor->depth.out;
    out->depth_stride = SYNTH_DEPTH_WIDTH * (ptrdiff_t)sizeof(uint16_t);
    out->depth_units_per_metre = 1000.0;
    out->has_pose = sensor->def.path != RLF_SYNTHETIC_PATH_NONE;
    out->T_world_camera = sensor->T_world_camera;
    return RLF_OK;
}

static rlf_result sensor_restart(void *self)
{
    synth_sensor *sensor = self;
    sensor->next_frame = 0;
    sensor->time = 0.0;
    sensor->has_frame = false;
    synth_sensor_see(sensor, 0.0, &sensor->scene);
    return RLF_OK;
}

/* Every frame depends on its number alone. */
static rlf_result sensor_seek(void *self, int64_t index)
{
    synth_sensor *sensor = self;
    sensor->next_frame = index;
    return RLF_OK;
}

static const rlf_truth *sensor_truth(void *self)
{
    synth_sensor *sensor = self;
    if (!sensor->has_frame || !sensor->def.enable_truth) {
        return NULL;
    }
    if (!sensor->depth.has_truth) {
        fill_truth(sensor);
    }
    return &sensor->truth;
}

synth_sensor *synth_sensor_of(const rlf_source *source)
{
    return rlf_source_get_self(source, sensor_next);
}

static void build_scene(synth_sensor *sensor)
{
    const rlf_synthetic_def *def = &sensor->def;
    if (def->scene == RLF_SYNTHETIC_RANDOM) {
        synth_random_build(&sensor->scene, &sensor->random, def);
    } else if (def->scene == RLF_SYNTHETIC_HANDS) {
        synth_hands_build(&sensor->scene, &sensor->hands, def);
    } else {
        synth_scene_build(&sensor->scene, def->scene);
        synth_scene_set_people(&sensor->scene, def->person);
        sensor->scene.speed = def->speed;
        sensor->scene.lamp = def->lamp;
    }
    sensor->T_world_camera = rlf_pose_identity();
    if (def->path != RLF_SYNTHETIC_PATH_NONE) {
        if (def->scene != RLF_SYNTHETIC_RANDOM && def->scene != RLF_SYNTHETIC_THESIS) {
            synth_path_close_room(&sensor->scene);
        }
        sensor->scene.is_moving = def->path != RLF_SYNTHETIC_PATH_OPPOSITE;
        sensor->rest = sensor->scene;
        synth_path_make(&sensor->path, def->path, &sensor->rest);
        sensor->T_world_camera = synth_path_pose(&sensor->path, 0.0);
        synth_path_see(&sensor->rest, &sensor->T_world_camera, &sensor->scene);
    }
    sensor->asked = sensor->scene;
}

static void set_noise(synth_sensor *sensor, const rlf_rig *rig)
{
    const rlf_synthetic_def *def = &sensor->def;
    synth_noise *noise = &sensor->depth.noise;
    synth_noise_init(noise, def->seed);
    noise->enable = def->enable_noise;
    noise->enable_steps = def->enable_structured_light;
    noise->enable_edge_filter = def->enable_edge_filter;
    noise->min_mm = (float)(1000.0 * rig->depth_min_m);
    noise->max_mm = (float)(1000.0 * rig->depth_max_m);
    noise->drawn = sensor->scene.random != NULL ? &sensor->random.noise : NULL;
}

/* Sets *rig as well. */
static rlf_result sensor_create(const rlf_synthetic_def *def, rlf_rig *rig, synth_sensor **out)
{
    synth_sensor *sensor = rlf_alloc(sizeof(*sensor));
    if (sensor == NULL) {
        return RLF_ERROR_MEMORY;
    }
    sensor->def = *def;
    build_scene(sensor);
    *rig = make_rig(def);
    if (sensor->scene.random != NULL) {
        set_drawn(rig, &sensor->random);
    }
    sensor->depth.view.camera = rig->depth;
    sensor->depth.pool = def->pool;
    set_noise(sensor, rig);
    rlf_result result = synth_depth_create(&sensor->depth, &sensor->scene, def->enable_truth);
    if (result == RLF_OK && def->enable_color) {
        sensor->color.view.camera = rig->color;
        sensor->color.view.origin = rlf_neg(rig->T_color_depth.p);
        sensor->color.pool = def->pool;
        sensor->color.is_coarse = def->opens_soon && !sensor->scene.is_moving;
        result = synth_color_create(&sensor->color, &sensor->scene);
    }
    if (result != RLF_OK) {
        sensor_destroy(sensor);
        return result;
    }
    *out = sensor;
    return RLF_OK;
}

rlf_result rlf_synthetic_create(const rlf_synthetic_def *def, rlf_source **out)
{
    if (!RLF_ASSERT(def != NULL && def->cookie == RLF_DEF_COOKIE && out != NULL)) {
        return RLF_ERROR_INVALID;
    }
    *out = NULL;
    rlf_result result = synth_def_check(def);
    if (result != RLF_OK) {
        return result;
    }
    rlf_source_info info = {.frame_count = def->frame_count,
                            .frames_per_second = def->frames_per_second,
                            .can_seek = true,
                            .is_simulated = true};
    (void)snprintf(info.name, sizeof(info.name), "synthetic:%s", synth_scene_name(def->scene));
    synth_sensor *sensor = NULL;
    result = sensor_create(def, &info.rig, &sensor);
    if (result != RLF_OK) {
        return result;
    }
    info.gravity = rlf_scale(sensor->scene.down, GRAVITY_M_S2);
    static const rlf_source_methods methods = {.next = sensor_next,
                                               .restart = sensor_restart,
                                               .truth = sensor_truth,
                                               .destroy = sensor_destroy,
                                               .seek = sensor_seek};
    result = rlf_source_create_custom(&methods, &info, sensor, out);
    if (result != RLF_OK) {
        sensor_destroy(sensor);
    }
    return result;
}
