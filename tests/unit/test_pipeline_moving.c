/* The frame loop with a camera that moves: a corner of a room, cast ray by ray, and a script. */

#include "relief/pipeline.h"
#include "test.h"

#include <math.h>
#include <string.h>

#define WIDTH 160
#define HEIGHT 120
#define STEP_NS 33333333
#define FLOOR_Y 1.1
#define DOWN 0.45 /* radians that the camera looks down by */
#define STILL 25  /* frames before the camera moves ... */
#define PERIOD 60 /* ... to the side and back */
#define THING_FROM 40
#define ABSORB_S 1.0

typedef struct room_source {
    uint16_t depth[WIDTH * HEIGHT];
    uint8_t is_thing[WIDTH * HEIGHT];
    rlf_camera camera;
    int64_t frame, frame_count;
    int64_t bad_frame;  /* its pose is none; < 0: all are good */
    int64_t lie_frame;  /* if not 0: its pose says that the camera moved */
    int64_t mute_frame; /* if not 0: from it on no pose is one */
    bool has_poses;     /* frames say where the camera is */
    bool stands;        /* the camera does not move */
    bool has_thing;     /* something comes before the wall */
    int64_t stop_frame; /* if not 0: from it on the camera stands where it is */
    bool is_other;      /* another room: its walls and floor are slanted */
    double reach;       /* of the motion, 1 */
} room_source;

static double to_box(const rlf_aabb *box, rlf_vec3 p, rlf_vec3 d)
{
    const double from[3] = {p.x, p.y, p.z}, way[3] = {d.x, d.y, d.z};
    const double low[3] = {box->min.x, box->min.y, box->min.z};
    const double high[3] = {box->max.x, box->max.y, box->max.z};
    double in = 0.0, out = 1e9;
    for (int k = 0; k < 3; k++) {
        const double w = fabs(way[k]) > 1e-12 ? way[k] : 1e-12;
        const double a = (low[k] - from[k]) / w, b = (high[k] - from[k]) / w;
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
    }
    return in < out && in > 0.0 ? in : 1e9;
}

static double to_room(rlf_vec3 p, rlf_vec3 d, bool has_thing)
{
    static const rlf_aabb things[] = {
        {{-0.75, 0.6, 1.2}, {-0.5, FLOOR_Y, 1.6}}, {{0.45, 0.7, 1.2}, {0.75, FLOOR_Y, 1.5}},
        {{-0.9, 0.6, 1.9}, {-0.5, FLOOR_Y, 2.3}},  {{0.5, 0.4, 2.2}, {0.8, FLOOR_Y, 2.6}},
        {{0.0, 0.0, 2.8}, {0.3, 0.3, 3.0}},        {{-0.2, 0.3, 1.5}, {0.1, 0.7, 1.6}},
    };
    double t = d.y > 0.0 ? (FLOOR_Y - p.y) / d.y : 1e9;
    t = d.z > 0.0 ? fmin(t, (3.0 - p.z) / d.z) : t;
    t = fmin(t, d.x < 0.0 ? (-1.0 - p.x) / d.x : d.x > 0.0 ? (1.1 - p.x) / d.x : 1e9);
    for (int i = 0; i < (has_thing ? 6 : 5); i++) {
        t = fmin(t, to_box(&things[i], p, d));
    }
    return t;
}

/* From the world, the first camera's frame, to the room's axes: x right, y down. */
static rlf_quat level(void)
{
    return rlf_quat_from_rotation_vector(rlf_vec3_make(-DOWN, 0.0, 0.0));
}

static rlf_pose pose_at(const room_source *s, int64_t frame)
{
    frame = s->stop_frame > 0 && frame > s->stop_frame ? s->stop_frame : frame;
    const double t = s->stands || frame < STILL ? 0.0 : (double)(frame - STILL) / PERIOD;
    const double swing = 0.5 - 0.5 * cos(2.0 * RLF_PI * t);
    const double far = s->reach * swing;
    return (rlf_pose){rlf_vec3_make(0.15 * far, 0.0, 0.05 * far),
                      rlf_quat_from_rotation_vector(rlf_vec3_make(0.0, 0.25 * far, 0.0))};
}

static rlf_result room_next(void *self, rlf_frame *out)
{
    room_source *s = self;
    if (s->frame == s->frame_count) {
        return RLF_END;
    }
    const rlf_pose T = pose_at(s, s->frame);
    const rlf_quat q = level();
    const bool has_thing = s->has_thing && s->frame >= THING_FROM;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(&s->camera, i % WIDTH, i / WIDTH, &ray);
        rlf_vec3 p = rlf_rotate(q, T.p), d = rlf_rotate(q, rlf_rotate(T.q, ray));
        if (s->is_other) {
            p = rlf_vec3_make(p.x + 0.3 * p.z, p.y + 0.3 * p.x, p.z);
            d = rlf_vec3_make(d.x + 0.3 * d.z, d.y + 0.3 * d.x, d.z);
        }
        const double room = to_room(p, d, false), z = has_thing ? to_room(p, d, true) : room;
        s->is_thing[i] = z < room;
        s->depth[i] = (uint16_t)(1000.0 * z + 0.5);
    }
    memset(out, 0, sizeof(*out));
    out->sequence = (uint64_t)s->frame;
    out->time_ns = s->frame * STEP_NS;
    out->depth_u16 = s->depth;
    out->depth_stride = WIDTH * sizeof(uint16_t);
    out->depth_units_per_metre = 1000;
    out->has_pose = s->has_poses;
    out->T_world_camera = T;
    if (s->frame == s->bad_frame) {
        out->T_world_camera.q.x = (double)NAN;
    }
    if (s->lie_frame > 0 && s->frame == s->lie_frame) {
        out->T_world_camera.p.x += 0.1;
    }
    if (s->mute_frame > 0 && s->frame >= s->mute_frame) {
        out->T_world_camera.p.x = (double)NAN;
    }
    s->frame++;
    return RLF_OK;
}

static room_source memory;

static rlf_map *map;

/* With voxels as coarse as the camera's pixels. */
static void open_map(const rlf_rig *rig)
{
    rlf_map_def def = rlf_map_def_default();
    def.rig = *rig;
    def.voxel_m = 0.015;
    assert_int_equal(rlf_map_create(&def, &map), RLF_OK);
}

static rlf_source *open_room(int64_t frame_count)
{
    rlf_source_info info;
    memset(&info, 0, sizeof(info));
    strcpy(info.name, "room");
    info.rig.depth = (rlf_camera){
        .width = WIDTH, .height = HEIGHT, .fx = 120, .fy = 120, .cx = 79.5, .cy = 59.5};
    info.rig.T_color_depth = rlf_pose_identity();
    info.rig.depth_min_m = 0.3;
    info.rig.depth_max_m = 8.0;
    info.rig.noise = (rlf_depth_noise){0.001, 0.0, 0.001};
    info.frame_count = frame_count;
    info.frames_per_second = 30;
    memset(&memory, 0, sizeof(memory));
    memory.camera = info.rig.depth;
    memory.frame_count = frame_count;
    memory.bad_frame = -1;
    memory.reach = 1.0;
    const rlf_source_methods methods = {.next = room_next};
    rlf_source *source = NULL;
    assert_int_equal(rlf_source_create_custom(&methods, &info, &memory, &source), RLF_OK);
    open_map(&info.rig);
    return source;
}

/* A cube that starts just above the floor. */
static rlf_pipeline *open_pipeline(rlf_source *source, rlf_camera_mode camera,
                                   rlf_pose_origin poses)
{
    rlf_body_def body = rlf_body_def_default();
    body.shape.size = rlf_vec3_make(0.2, 0.2, 0.2);
    const rlf_quat T_world_room = rlf_quat_conjugate(level());
    body.position = rlf_rotate(T_world_room, rlf_vec3_make(0.1, FLOOR_Y - 0.12, 1.8));
    body.orientation = T_world_room;
    body.restitution = 0.0;
    const rlf_scene scene = {.gravity = rlf_rotate(T_world_room, rlf_vec3_make(0.0, 9.81, 0.0)),
                             .bodies = &body,
                             .body_count = 1};
    rlf_pipeline_def def = rlf_pipeline_def_default(RLF_PROFILE_LIVE, source, NULL);
    def.scene = &scene;
    def.enable_render = false;
    def.camera = camera;
    def.poses = poses;
    def.map = map;
    def.reconstruct.absorb_after_s = ABSORB_S;
    rlf_pipeline *pipeline = NULL;
    assert_int_equal(rlf_pipeline_create(&def, &pipeline), RLF_OK);
    return pipeline;
}

static void close_all(rlf_pipeline **pipeline, rlf_source **source)
{
    rlf_pipeline_destroy(pipeline);
    rlf_source_destroy(source);
    rlf_map_destroy(&map);
}

static rlf_vec3 place_of(const rlf_pipeline_output *out)
{
    return out->snapshot->bodies[0].T_world_body.p;
}

static void bodies_stay_in_the_world_when_the_camera_begins_to_move(void **state)
{
    (void)state;
    rlf_source *source = open_room(STILL + PERIOD);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    rlf_pipeline_output out;
    rlf_vec3 rest = {0, 0, 0};
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        if (out.frame_index < STILL) {
            rest = place_of(&out);
            assert_null(out.track);
            continue;
        }
        assert_true(rlf_length(rlf_sub(place_of(&out), rest)) < 0.01);
        if (out.track != NULL) {
            const rlf_pose T = pose_at(&memory, out.frame_index);
            assert_int_equal(out.track->health, RLF_TRACK_GOOD);
            assert_true(rlf_length(rlf_sub(out.T_world_camera.p, T.p)) < 0.01);
        }
    }
    assert_int_equal(out.frame_index, STILL + PERIOD - 1);
    assert_non_null(out.track);
    assert_non_null(rlf_pipeline_get_map(pipeline));
    close_all(&pipeline, &source);
}

static void bodies_wait_until_it_is_sure_that_the_camera_moves(void **state)
{
    (void)state;
    rlf_source *source = open_room(STILL + PERIOD);
    memory.frame = STILL + PERIOD / 8;
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    rlf_pipeline_output out = {.track = NULL};
    rlf_vec3 before = {0, 0, 0};
    int32_t waits = 0;
    while (out.track == NULL) {
        assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
        if (out.surface->camera_may_move) {
            assert_true(rlf_length(rlf_sub(place_of(&out), before)) == 0.0);
            waits++;
        }
        before = place_of(&out);
    }
    assert_true(waits > 0);
    close_all(&pipeline, &source);
}

static uint64_t run_hash(rlf_camera_mode camera, bool has_poses)
{
    rlf_source *source = open_room(STILL);
    rlf_pipeline *pipeline = open_pipeline(source, camera, RLF_POSES_TRACKED);
    rlf_pipeline_output out;
    memory.stands = true;
    memory.has_poses = has_poses;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        assert_null(out.track);
    }
    assert_null(rlf_pipeline_get_map(pipeline));
    const uint64_t hash = rlf_world_hash(rlf_pipeline_get_world(pipeline));
    close_all(&pipeline, &source);
    return hash;
}

static void a_camera_that_stands_is_as_a_fixed_one(void **state)
{
    (void)state;
    const uint64_t fixed = run_hash(RLF_CAMERA_FIXED, false);
    assert_int_equal(run_hash(RLF_CAMERA_AUTO, false), fixed);
    assert_int_equal(run_hash(RLF_CAMERA_AUTO, true), fixed);
}

/* It is carried, and put down: two seconds later it is as good as one that never moved. */
static void a_camera_that_is_put_down_stands_again(void **state)
{
    (void)state;
    const int64_t stop = STILL + PERIOD / 4, last = stop + 110;
    rlf_source *source = open_room(last);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    rlf_pipeline_output out;
    rlf_vec3 rest = {0, 0, 0};
    rlf_pose before = rlf_pose_identity();
    int32_t tracked = 0;
    int64_t stood = 0;
    memory.stop_frame = stop;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        const bool is_tracked = out.track != NULL;
        tracked += is_tracked;
        rest = out.frame_index < STILL ? place_of(&out) : rest;
        assert_true(rlf_length(rlf_sub(place_of(&out), rest)) < 0.01 || out.frame_index < STILL);
        if (tracked > 0 && !is_tracked) {
            stood = stood > 0 ? stood : out.frame_index;
            memory.has_thing = out.frame_index >= last - 5;
            assert_true(rlf_length(rlf_sub(out.T_world_camera.p, before.p)) == 0.0);
            assert_int_equal(out.surface->background_state, RLF_BACKGROUND_READY);
        }
        before = out.T_world_camera;
    }
    assert_true(stood > stop + 55 && stood < stop + 85);
    assert_true(rlf_length(rlf_sub(before.p, pose_at(&memory, stop).p)) < 0.01);
    assert_true(out.surface->foreground_count > 500); /* what has come before the wall */
    close_all(&pipeline, &source);
}

/* It is carried, and nobody says to where: it is lost, but what it sees stands still. */
static void bodies_wait_a_second_at_most_for_a_room_that_stands_still(void **state)
{
    (void)state;
    const int64_t stop = STILL + PERIOD / 4;
    rlf_source *source = open_room(stop + 60);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_AUTO, RLF_POSES_SOURCE);
    rlf_pipeline_output out;
    int64_t time = 0;
    int32_t waited = 0, longest = 0, lost = 0;
    memory.has_poses = true;
    memory.stop_frame = stop;
    memory.mute_frame = STILL;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        lost += out.track != NULL && out.track->health == RLF_TRACK_LOST;
        waited = out.snapshot->time_ns > time || out.frame_index < stop ? 0 : waited + 1;
        longest = waited > longest ? waited : longest;
        time = out.snapshot->time_ns;
    }
    assert_true(lost > 10);
    assert_true(longest > 1 && longest <= 30);
    assert_null(out.track);
    close_all(&pipeline, &source);
}

/* A source says that the camera moved, and then nothing: it stands where it stood. */
static void a_camera_that_cannot_be_placed_stands_where_it_stood(void **state)
{
    (void)state;
    rlf_source *source = open_room(STILL + 40);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_AUTO, RLF_POSES_SOURCE);
    rlf_pipeline_output out;
    int32_t tracked = 0;
    memory.stands = memory.has_poses = true;
    memory.lie_frame = STILL;
    memory.mute_frame = STILL + 1;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        tracked += out.track != NULL;
        assert_true(out.track == NULL || out.frame_index >= STILL);
    }
    assert_true(tracked > 0 && tracked < 15);
    assert_true(rlf_length(out.T_world_camera.p) == 0.0);
    assert_int_equal(out.surface->background_state, RLF_BACKGROUND_READY);
    close_all(&pipeline, &source);
}

static void what_comes_before_the_room_is_foreground(void **state)
{
    (void)state;
    rlf_source *source = open_room(THING_FROM + 8);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    rlf_pipeline_output out;
    memory.has_thing = true;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        assert_int_equal(out.track->health, RLF_TRACK_GOOD); /* from the first frame on */
        int32_t thing = 0, found = 0;
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
            thing += memory.is_thing[i];
            found += memory.is_thing[i] && out.surface->foreground[i];
        }
        if (out.frame_index >= THING_FROM) {
            assert_true(thing > 500 && found > 95 * thing / 100);
            assert_true(out.surface->foreground_count < 103 * thing / 100);
        } else {
            assert_int_equal(out.surface->foreground_count, 0);
        }
    }
    close_all(&pipeline, &source);
}

static void what_is_put_down_becomes_the_room(void **state)
{
    (void)state;
    rlf_source *source = open_room(THING_FROM + 75);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    rlf_pipeline_output out;
    memory.has_thing = true;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        const bool is_visitor = out.frame_index >= THING_FROM && out.frame_index < THING_FROM + 25;
        int32_t front = 0;
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
            front += memory.is_thing[i] && out.surface->foreground[i];
        }
        assert_true(!is_visitor || front > 300);
        assert_true(out.frame_index < THING_FROM + 70 || front == 0);
    }
    close_all(&pipeline, &source);
}

static int32_t told;

static void count_poses(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    (void)level;
    told += strstr(line, "poses of the source") != NULL;
}

static void a_camera_whose_poses_change_is_tracked_at_once(void **state)
{
    (void)state;
    rlf_source *source = open_room(STILL + PERIOD);
    memory.has_poses = true;
    memory.frame = STILL + PERIOD / 4;
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    rlf_pipeline_output out;
    assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    assert_null(out.track);
    assert_int_equal(rlf_pipeline_step(pipeline, &out), RLF_OK);
    assert_non_null(out.track);
    close_all(&pipeline, &source);
}

static void a_pose_that_is_none_is_told_once_and_left_out(void **state)
{
    (void)state;
    rlf_source *source = open_room(STILL + 20);
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_MOVING, RLF_POSES_SOURCE);
    rlf_pipeline_output out;
    memory.has_poses = true;
    memory.bad_frame = STILL + 10;
    told = 0;
    rlf_set_log(count_poses, NULL);
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
        const bool is_bad = out.frame_index == memory.bad_frame;
        const rlf_pose T = pose_at(&memory, out.frame_index - (is_bad ? 1 : 0));
        assert_int_equal(out.track->health, is_bad ? RLF_TRACK_LOST : RLF_TRACK_GOOD);
        assert_true(rlf_length(rlf_sub(out.T_world_camera.p, T.p)) < 1e-9);
    }
    rlf_set_log(NULL, NULL);
    assert_int_equal(told, 1);
    assert_int_equal(rlf_map_get_status(rlf_pipeline_get_map(pipeline)).frames, STILL + 19);
    close_all(&pipeline, &source);
}

/* The pose of the first frame that a new pipeline sees in a room that is mapped. */
static rlf_track_health first_in_known_room(rlf_source *source, rlf_pose *out)
{
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    rlf_pipeline_output frame;
    memory.frame = STILL + 20;
    assert_int_equal(rlf_pipeline_step(pipeline, &frame), RLF_OK);
    const rlf_track_health health = frame.track->health;
    *out = frame.T_world_camera;
    rlf_pipeline_destroy(&pipeline);
    return health;
}

static void a_camera_is_found_where_a_known_room_was_seen_from(void **state)
{
    (void)state;
    rlf_source *source = open_room(STILL + PERIOD);
    memory.reach = 2.0;
    memory.frame = STILL - 5;
    rlf_pipeline *pipeline = open_pipeline(source, RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    rlf_pipeline_output out;
    while (rlf_pipeline_step(pipeline, &out) == RLF_OK) {
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_pose found;
    assert_int_equal(first_in_known_room(source, &found), RLF_TRACK_GOOD);
    const rlf_pose T = pose_at(&memory, STILL + 20);
    assert_true(rlf_length(rlf_sub(found.p, T.p)) < 0.02);
    memory.is_other = true;
    assert_int_equal(first_in_known_room(source, &found), RLF_TRACK_LOST);
    close_all(&pipeline, &source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_stay_in_the_world_when_the_camera_begins_to_move),
        cmocka_unit_test(bodies_wait_until_it_is_sure_that_the_camera_moves),
        cmocka_unit_test(a_camera_that_stands_is_as_a_fixed_one),
        cmocka_unit_test(a_camera_that_is_put_down_stands_again),
        cmocka_unit_test(bodies_wait_a_second_at_most_for_a_room_that_stands_still),
        cmocka_unit_test(a_camera_that_cannot_be_placed_stands_where_it_stood),
        cmocka_unit_test(what_comes_before_the_room_is_foreground),
        cmocka_unit_test(what_is_put_down_becomes_the_room),
        cmocka_unit_test(a_camera_whose_poses_change_is_tracked_at_once),
        cmocka_unit_test(a_pose_that_is_none_is_told_once_and_left_out),
        cmocka_unit_test(a_camera_is_found_where_a_known_room_was_seen_from),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
