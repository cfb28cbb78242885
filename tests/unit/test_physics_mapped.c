/* In a room that is known from a map, bodies live on where the camera does not look. */
#include "mapped_room.h"
#include "each_world.h"
#include "test.h"

#define FRAME (1.0 / 30)

static mapped_room room;
static rlf_map *map;
static const rlf_vec3 eye = {0.0, 0.0, -1.2};
static const rlf_aabb table = {{-0.4, 0.5, 0.3}, {0.4, MAPPED_FLOOR, 0.7}};

static int set_up(void **state)
{
    (void)state;
    mapped_room_init(&room);
    room.solids[room.solid_count++] = table;
    map = mapped_room_map(&room);
    return map != NULL ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    rlf_map_destroy(&map);
    return 0;
}

static int start(void **state)
{
    start_world(state);
    rlf_world_set_room(world, map);
    return 0;
}

static void add(rlf_shape shape, rlf_vec3 position, rlf_vec3 velocity)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = shape;
    def.position = position;
    def.velocity = velocity;
    def.restitution = 0.2;
    add_body(world, &def);
}

static rlf_shape cube(double size)
{
    return (rlf_shape){.type = RLF_SHAPE_BOX, .size = {size, size, size}};
}

static rlf_shape ball(double radius)
{
    return (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = radius};
}

static const rlf_body_state *body(int32_t k)
{
    const rlf_snapshot *snapshot = rlf_world_get_snapshot(world);
    assert_true(k < snapshot->body_count);
    return &snapshot->bodies[k];
}

static bool is_in_view(rlf_vec3 p)
{
    double u, v;
    return mapped_room_project(NULL, rlf_transform_inverse(&room.grid.T_world_grid, p), &u, &v);
}

/* The camera looks that way while time goes on. */
static void look(double yaw, double seconds)
{
    const rlf_pose T = mapped_room_pose(eye, yaw, 0.3);
    mapped_room_look(&room, &T);
    for (int32_t k = 0; k * FRAME < seconds; k++) {
        room.grid.time_ns += 33333333;
        rlf_world_advance(world, &room.grid, FRAME);
    }
}

/* Turns it on from yaw to yaw, frame by frame. */
static void pan(double from, double to, int32_t frames)
{
    for (int32_t k = 1; k <= frames; k++) {
        look(from + (to - from) * k / frames, FRAME);
    }
}

/* Behind the camera, dropped from half a metre: all shapes lie on the floor. */
TEST_CASE(what_falls_out_of_view_lies_on_the_floor)
{
    const rlf_shape shapes[5] = {cube(0.1),
                                 ball(0.06),
                                 ball(0.2),
                                 {.type = RLF_SHAPE_CAPSULE, .radius = 0.05, .height = 0.1},
                                 {.type = RLF_SHAPE_CYLINDER, .radius = 0.05, .height = 0.1}};
    for (int32_t k = 0; k < 5; k++) {
        add(shapes[k], rlf_vec3_make(-1.4 + 0.7 * k, 0.4, -1.5), rlf_vec3_make(0, 0, 0));
    }
    look(0.0, 1.5);
    const double heights[5] = {0.05, 0.06, 0.2, 0.1, 0.05}; /* the capsule stands */
    for (int32_t k = 0; k < 5; k++) {
        double off = MAPPED_FLOOR - heights[k] - body(k)->T_world_body.p.y;
        assert_false(is_in_view(body(k)->T_world_body.p));
        if (!(off < 0.01 && off > -0.01)) {
            fail_msg("shape %d: %.1f mm over the floor", k, 1000 * off);
        }
    }
}

/* In all ways, by day and by night: nothing passes a wall that nobody sees. */
TEST_CASE(nothing_tunnels_at_10_m_s)
{
    for (int32_t k = 0; k < 24; k++) {
        double angle = k * (RLF_PI / 12.0);
        rlf_vec3 v = rlf_vec3_make(10.0 * rlf_cos(angle), k % 3 - 1.0, 10.0 * rlf_sin(angle));
        add(k % 2 == 0 ? ball(0.04) : cube(0.06), rlf_vec3_make(0, -0.3, -0.6), v);
    }
    for (int32_t frame = 0; frame < 45; frame++) {
        if (frame % 15 == 0) {
            look(0.5 * RLF_PI * frame, FRAME);
        }
        rlf_world_advance(world, frame < 30 ? &room.grid : NULL, FRAME);
        for (int32_t k = 0; k < 24; k++) {
            rlf_vec3 p = body(k)->T_world_body.p;
            bool is_in = p.x < 2 && p.x > -2 && p.y < 1 && p.y > -1.2 && p.z < 2 && p.z > -2;
            if (!is_in) {
                fail_msg("body %d, frame %d: at %.3f %.3f %.3f", k, frame, p.x, p.y, p.z);
            }
        }
    }
}

/* It rolls, and slides, across the border and goes on as it went. */
TEST_CASE(border_is_no_seam)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape = ball(0.06);
    def.position = rlf_vec3_make(0.2, MAPPED_FLOOR - 0.06, 0.0);
    def.velocity = rlf_vec3_make(0.8, 0, 0);
    def.angular_velocity = rlf_vec3_make(0, 0, 0.8 / 0.06);
    add_body(world, &def);
    def.shape = cube(0.1);
    def.position = rlf_vec3_make(0.2, MAPPED_FLOOR - 0.05, -0.25);
    def.angular_velocity = rlf_vec3_make(0, 0, 0);
    def.friction = 0.0;
    add_body(world, &def);
    look(0.0, FRAME);
    assert_true(is_in_view(body(0)->T_world_body.p) && is_in_view(body(1)->T_world_body.p));
    for (int32_t frame = 0; frame < 54; frame++) {
        look(0.0, FRAME);
        for (int32_t k = 0; k < 2; k++) {
            rlf_vec3 v = body(k)->velocity;
            if (!(v.x > 0.77 && v.x < 0.83 && v.y < 0.1 && v.y > -0.1)) {
                print_message("body %d, frame %d: %.3f %.3f %.3f m/s at x %.2f\n", k, frame, v.x,
                              v.y, v.z, body(k)->T_world_body.p.x);
            }
            assert_true(v.x > 0.76 && v.x < 0.84 && v.y < 0.1 && v.y > -0.1);
        }
    }
    assert_false(is_in_view(body(0)->T_world_body.p) || is_in_view(body(1)->T_world_body.p));
}

/* The camera turns away from a stack, all about and back. */
TEST_CASE(a_stack_sleeps_while_nobody_looks)
{
    for (int32_t k = 0; k < 3; k++) {
        add(cube(0.1), rlf_vec3_make(0, table.min.y - 0.05 - 0.1 * k, 0.5), rlf_vec3_make(0, 0, 0));
    }
    look(0.0, 2.5);
    rlf_vec3 rested[3];
    for (int32_t k = 0; k < 3; k++) {
        assert_true(body(k)->is_asleep);
        rested[k] = body(k)->T_world_body.p;
    }
    for (int32_t quarter = 0; quarter < 16; quarter++) {
        pan(quarter * (RLF_PI / 8.0), (quarter + 1) * (RLF_PI / 8.0), 4);
        for (int32_t k = 0; k < 3; k++) {
            assert_true(body(k)->is_asleep);
            assert_true(rlf_length(rlf_sub(body(k)->T_world_body.p, rested[k])) == 0.0);
        }
    }
    rlf_world_advance(world, NULL, FRAME); /* no grid at all */
    assert_true(body(0)->is_asleep);
}

/* The table is 40 cm deep; from the front alone 30 cm more would be guessed where its top is seen
 * at a low angle. Behind it is free floor, and its back is a wall. */
TEST_CASE(real_backs_replace_guesses)
{
    add(cube(0.1), rlf_vec3_make(0, 0.8, 0.8), rlf_vec3_make(0, 0, 0));
    add(ball(0.05), rlf_vec3_make(0.2, 0.9, 1.6), rlf_vec3_make(0, 0, -3));
    look(0.0, 0.1);
    look(0.0, 1.5);
    rlf_vec3 p = body(0)->T_world_body.p, b = body(1)->T_world_body.p;
    if (!(p.z > 0.74 && p.z < 0.9)) {
        print_message("cube at %.3f %.3f %.3f, ball %.3f %.3f %.3f\n", p.x, p.y, p.z, b.x, b.y,
                      b.z);
    }
    assert_true(p.y > 0.94 && p.y < 0.96);
    assert_true(p.z > 0.74 && p.z < 0.9);
    assert_true(b.z > table.max.z + 0.04 && b.y > 0.93 && b.y < 0.96);
}

/* A frame that shows all a per cent too near, as sensors do, moves nothing: what stands is where
 * the map of many views has it. */
TEST_CASE(frames_do_not_shake_what_stands)
{
    const rlf_vec3 none = {0, 0, 0};
    add(cube(0.1), rlf_vec3_make(0.1, table.min.y - 0.051, 0.45), none);
    add(ball(0.05), rlf_vec3_make(-0.2, table.min.y - 0.051, 0.45), none);
    add(cube(0.1), rlf_vec3_make(0.9, MAPPED_FLOOR - 0.051, 0.3), none);
    const double heights[3] = {table.min.y, table.min.y, MAPPED_FLOOR};
    const rlf_pose T = mapped_room_pose(eye, 0.0, 0.3);
    for (int32_t frame = 0; frame < 45; frame++) {
        mapped_room_look(&room, &T);
        for (int32_t i = 0; frame % 3 == 0 && i < room.grid.width * room.grid.height; i++) {
            room.depth[i] *= 0.99f;
        }
        room.grid.time_ns += 33333333;
        rlf_world_advance(world, &room.grid, FRAME);
        for (int32_t k = 0; k < 3; k++) {
            double over = heights[k] - 0.05 - body(k)->T_world_body.p.y;
            assert_true(is_in_view(body(k)->T_world_body.p));
            if (!(over < 0.004 && over > -0.004)) {
                fail_msg("body %d, frame %d: %.1f mm", k, frame, 1000 * over);
            }
        }
    }
}

/* What the map does not know is as without one. */
TEST_CASE(where_nobody_looked_there_is_nothing)
{
    rlf_map_def def = rlf_map_def_default();
    def.rig = room.rig;
    def.memory_mb = 8;
    rlf_map *empty = map_of(&def);
    uint64_t hashes[2];
    for (int32_t k = 0; k < 2; k++) {
        rlf_world_reset(world);
        rlf_world_set_room(world, k == 0 ? NULL : empty);
        add(cube(0.1), rlf_vec3_make(0.1, 0.3, 0.4), rlf_vec3_make(1, 0, 0));
        add(ball(0.1), rlf_vec3_make(0.3, 0.3, -0.1), rlf_vec3_make(2, 0, 0));
        look(0.0, 1.0);
        hashes[k] = rlf_world_hash(world);
    }
    rlf_world_set_room(world, NULL);
    rlf_map_destroy(&empty);
    assert_true(hashes[0] == hashes[1]);
}

TEST_GROUP(set_up, tear_down)
TEST_EACH(start, stop_world)
