/* The frame loop with a camera that moves: a corner of a room, cast ray by ray, and a script. */

#include "analytic.h"
#include "drawn_source.h"
#include "test.h"

#include <math.h>

#define WIDTH 160
#define HEIGHT 120
#define FLOOR_Y 1.1
#define DOWN 0.45 /* radians that the camera looks down by */
#define STILL 25  /* frames before the camera moves ... */
#define PERIOD 60 /* ... to the side and back */
#define THING_FROM 40
#define ABSORB_S 1.0

static struct room {
    uint8_t is_thing[WIDTH * HEIGHT];
    int64_t bad_frame;  /* its pose is none; < 0: all are good */
    int64_t lie_frame;  /* if not 0: its pose says that the camera moved */
    int64_t mute_frame; /* if not 0: from it on no pose is one */
    bool has_poses;     /* frames say where the camera is */
    bool stands;        /* the camera does not move */
    bool has_thing;     /* something comes before the wall */
    int64_t stop_frame; /* if not 0: from it on the camera stands where it is */
    bool is_other;      /* another room: its walls and floor are slanted */
    double reach;       /* of the motion, 1 */
} memory;

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
        double in, leave;
        t = box_ray(&things[i], p, d, &in, &leave) && in > 0.0 ? fmin(t, in) : t;
    }
    return t;
}

/* From the world, the first camera's frame, to the room's axes: x right, y down. */
static rlf_quat level(void)
{
    return rlf_quat_from_rotation_vector(rlf_vec3_make(-DOWN, 0.0, 0.0));
}

static rlf_pose pose_at(int64_t frame)
{
    const struct room *s = &memory;
    frame = s->stop_frame > 0 && frame > s->stop_frame ? s->stop_frame : frame;
    const double t = s->stands || frame < STILL ? 0.0 : (double)(frame - STILL) / PERIOD;
    const double swing = 0.5 - 0.5 * cos(2.0 * RLF_PI * t);
    const double far = s->reach * swing;
    return (rlf_pose){rlf_vec3_make(0.15 * far, 0.0, 0.05 * far),
                      rlf_quat_from_rotation_vector(rlf_vec3_make(0.0, 0.25 * far, 0.0))};
}

static void draw(rlf_frame *frame)
{
    struct room *s = &memory;
    const rlf_pose T = pose_at(drawn.frame);
    const rlf_quat q = level();
    const bool has_thing = s->has_thing && drawn.frame >= THING_FROM;
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        rlf_vec3 ray;
        (void)rlf_camera_unproject(&drawn.camera, i % WIDTH, i / WIDTH, &ray);
        rlf_vec3 p = rlf_rotate(q, T.p), d = rlf_rotate(q, rlf_rotate(T.q, ray));
        if (s->is_other) {
            p = rlf_vec3_make(p.x + 0.3 * p.z, p.y + 0.3 * p.x, p.z);
            d = rlf_vec3_make(d.x + 0.3 * d.z, d.y + 0.3 * d.x, d.z);
        }
        const double room = to_room(p, d, false), z = has_thing ? to_room(p, d, true) : room;
        s->is_thing[i] = z < room;
        drawn.depth[i] = (uint16_t)(1000.0 * z + 0.5);
    }
    frame->has_pose = s->has_poses;
    frame->T_world_camera = T;
    if (drawn.frame == s->bad_frame) {
        frame->T_world_camera.q.x = (double)NAN;
    }
    if (s->lie_frame > 0 && drawn.frame == s->lie_frame) {
        frame->T_world_camera.p.x += 0.1;
    }
    if (s->mute_frame > 0 && drawn.frame >= s->mute_frame) {
        frame->T_world_camera.p.x = (double)NAN;
    }
}

static rlf_map *map;

/* With voxels as coarse as the camera's pixels. */
static void open_map(const rlf_rig *rig)
{
    rlf_map_def def = rlf_map_def_default();
    def.rig = *rig;
    def.voxel_m = 0.015;
    map = map_of(&def);
}

static void open_room(int64_t frame_count)
{
    const rlf_source_info info = drawn_info(WIDTH, HEIGHT, 120, frame_count);
    memory = (struct room){.bad_frame = -1, .reach = 1.0};
    open_drawn(&info, draw);
    open_map(&info.rig);
}

/* A cube that starts just above the floor. */
static void open_pipeline(rlf_camera_mode camera, rlf_pose_origin poses)
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
    pipeline = pipeline_of(&def);
}

static int close_all(void **state)
{
    close_drawn(state);
    rlf_map_destroy(&map);
    return 0;
}

static rlf_vec3 place(void)
{
    return out.snapshot->bodies[0].T_world_body.p;
}

TEST_CASE(bodies_stay_in_the_world_when_the_camera_begins_to_move)
{
    open_room(STILL + PERIOD);
    open_pipeline(RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    rlf_vec3 rest = {0, 0, 0};
    while (step()) {
        if (out.frame_index < STILL) {
            rest = place();
            assert_null(out.track);
            continue;
        }
        assert_true(rlf_length(rlf_sub(place(), rest)) < 0.01);
        if (out.track != NULL) {
            const rlf_pose T = pose_at(out.frame_index);
            assert_int_equal(out.track->health, RLF_TRACK_GOOD);
            assert_true(rlf_length(rlf_sub(out.T_world_camera.p, T.p)) < 0.01);
        }
    }
    assert_int_equal(out.frame_index, STILL + PERIOD - 1);
    assert_non_null(out.track);
    assert_non_null(rlf_pipeline_get_map(pipeline));
}

TEST_CASE(bodies_wait_until_it_is_sure_that_the_camera_moves)
{
    open_room(STILL + PERIOD);
    drawn.frame = STILL + PERIOD / 8;
    open_pipeline(RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    out.track = NULL;
    rlf_vec3 before = {0, 0, 0};
    int32_t waits = 0;
    while (out.track == NULL) {
        assert_true(step());
        if (out.surface->camera_may_move) {
            assert_true(rlf_length(rlf_sub(place(), before)) == 0.0);
            waits++;
        }
        before = place();
    }
    assert_true(waits > 0);
}

static uint64_t run_hash(rlf_camera_mode camera, bool has_poses)
{
    open_room(STILL);
    open_pipeline(camera, RLF_POSES_TRACKED);
    memory.stands = true;
    memory.has_poses = has_poses;
    while (step()) {
        assert_null(out.track);
    }
    assert_null(rlf_pipeline_get_map(pipeline));
    const uint64_t hash = rlf_world_hash(rlf_pipeline_get_world(pipeline));
    close_all(NULL);
    return hash;
}

TEST_CASE(a_camera_that_stands_is_as_a_fixed_one)
{
    const uint64_t fixed = run_hash(RLF_CAMERA_FIXED, false);
    assert_int_equal(run_hash(RLF_CAMERA_AUTO, false), fixed);
    assert_int_equal(run_hash(RLF_CAMERA_AUTO, true), fixed);
}

/* It is carried, and put down: two seconds later it is as good as one that never moved. */
TEST_CASE(a_camera_that_is_put_down_stands_again)
{
    const int64_t stop = STILL + PERIOD / 4, last = stop + 110;
    open_room(last);
    open_pipeline(RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    rlf_vec3 rest = {0, 0, 0};
    rlf_pose before = rlf_pose_identity();
    int32_t tracked = 0;
    int64_t stood = 0;
    memory.stop_frame = stop;
    while (step()) {
        const bool is_tracked = out.track != NULL;
        tracked += is_tracked;
        rest = out.frame_index < STILL ? place() : rest;
        assert_true(rlf_length(rlf_sub(place(), rest)) < 0.01 || out.frame_index < STILL);
        if (tracked > 0 && !is_tracked) {
            stood = stood > 0 ? stood : out.frame_index;
            memory.has_thing = out.frame_index >= last - 5;
            assert_true(rlf_length(rlf_sub(out.T_world_camera.p, before.p)) == 0.0);
            assert_int_equal(out.surface->background_state, RLF_BACKGROUND_READY);
        }
        before = out.T_world_camera;
    }
    assert_true(stood > stop + 55 && stood < stop + 85);
    assert_true(rlf_length(rlf_sub(before.p, pose_at(stop).p)) < 0.01);
    assert_true(out.surface->foreground_count > 500); /* what has come before the wall */
}

/* It is carried, and nobody says to where: it is lost, but what it sees stands still. */
TEST_CASE(bodies_wait_a_second_at_most_for_a_room_that_stands_still)
{
    const int64_t stop = STILL + PERIOD / 4;
    open_room(stop + 60);
    open_pipeline(RLF_CAMERA_AUTO, RLF_POSES_SOURCE);
    int64_t time = 0;
    int32_t waited = 0, longest = 0, lost = 0;
    memory.has_poses = true;
    memory.stop_frame = stop;
    memory.mute_frame = STILL;
    while (step()) {
        lost += out.track != NULL && out.track->health == RLF_TRACK_LOST;
        waited = out.snapshot->time_ns > time || out.frame_index < stop ? 0 : waited + 1;
        longest = waited > longest ? waited : longest;
        time = out.snapshot->time_ns;
    }
    assert_true(lost > 10);
    assert_true(longest > 1 && longest <= 30);
    assert_null(out.track);
}

/* A source says that the camera moved, and then nothing: it stands where it stood. */
TEST_CASE(a_camera_that_cannot_be_placed_stands_where_it_stood)
{
    open_room(STILL + 40);
    open_pipeline(RLF_CAMERA_AUTO, RLF_POSES_SOURCE);
    int32_t tracked = 0;
    memory.stands = memory.has_poses = true;
    memory.lie_frame = STILL;
    memory.mute_frame = STILL + 1;
    while (step()) {
        tracked += out.track != NULL;
        assert_true(out.track == NULL || out.frame_index >= STILL);
    }
    assert_true(tracked > 0 && tracked < 15);
    assert_true(rlf_length(out.T_world_camera.p) == 0.0);
    assert_int_equal(out.surface->background_state, RLF_BACKGROUND_READY);
}

TEST_CASE(what_comes_before_the_room_is_foreground)
{
    open_room(THING_FROM + 8);
    open_pipeline(RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    memory.has_thing = true;
    while (step()) {
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
}

TEST_CASE(what_is_put_down_becomes_the_room)
{
    open_room(THING_FROM + 75);
    open_pipeline(RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    memory.has_thing = true;
    while (step()) {
        const bool is_visitor = out.frame_index >= THING_FROM && out.frame_index < THING_FROM + 25;
        int32_t front = 0;
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
            front += memory.is_thing[i] && out.surface->foreground[i];
        }
        assert_true(!is_visitor || front > 300);
        assert_true(out.frame_index < THING_FROM + 70 || front == 0);
    }
}

static int32_t told;

static void count_poses(void *context, rlf_log_level level, const char *line)
{
    (void)context;
    (void)level;
    told += strstr(line, "poses of the source") != NULL;
}

TEST_CASE(a_camera_whose_poses_change_is_tracked_at_once)
{
    open_room(STILL + PERIOD);
    memory.has_poses = true;
    drawn.frame = STILL + PERIOD / 4;
    open_pipeline(RLF_CAMERA_AUTO, RLF_POSES_TRACKED);
    assert_true(step());
    assert_null(out.track);
    assert_true(step());
    assert_non_null(out.track);
}

TEST_CASE(a_pose_that_is_none_is_told_once_and_left_out)
{
    open_room(STILL + 20);
    open_pipeline(RLF_CAMERA_MOVING, RLF_POSES_SOURCE);
    memory.has_poses = true;
    memory.bad_frame = STILL + 10;
    told = 0;
    rlf_set_log(count_poses, NULL);
    while (step()) {
        const bool is_bad = out.frame_index == memory.bad_frame;
        const rlf_pose T = pose_at(out.frame_index - (is_bad ? 1 : 0));
        assert_int_equal(out.track->health, is_bad ? RLF_TRACK_LOST : RLF_TRACK_GOOD);
        assert_true(rlf_length(rlf_sub(out.T_world_camera.p, T.p)) < 1e-9);
    }
    rlf_set_log(NULL, NULL);
    assert_int_equal(told, 1);
    assert_int_equal(rlf_map_get_status(rlf_pipeline_get_map(pipeline)).frames, STILL + 19);
}

/* The pose of the first frame that a new pipeline sees in a room that is mapped. */
static rlf_track_health first_in_known_room(rlf_pose *found)
{
    open_pipeline(RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    drawn.frame = STILL + 20;
    assert_true(step());
    const rlf_track_health health = out.track->health;
    *found = out.T_world_camera;
    rlf_pipeline_destroy(&pipeline);
    return health;
}

TEST_CASE(a_camera_is_found_where_a_known_room_was_seen_from)
{
    open_room(STILL + PERIOD);
    memory.reach = 2.0;
    drawn.frame = STILL - 5;
    open_pipeline(RLF_CAMERA_MOVING, RLF_POSES_TRACKED);
    while (step()) {
    }
    rlf_pipeline_destroy(&pipeline);
    rlf_pose found;
    assert_int_equal(first_in_known_room(&found), RLF_TRACK_GOOD);
    const rlf_pose T = pose_at(STILL + 20);
    assert_true(rlf_length(rlf_sub(found.p, T.p)) < 0.02);
    memory.is_other = true;
    assert_int_equal(first_in_known_room(&found), RLF_TRACK_LOST);
}

TEST_EACH(NULL, close_all)
