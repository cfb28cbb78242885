/* A body on the grid: bounce heights, friction, rest, missing pixels. Live method. */
#include "draws.h"
#include "each_world.h"
#include "grid_shared.h"
#include "hulls.h"
#include "test.h"

#include <math.h>

static void set_floor(double height)
{
    grid_plane room[2] = {grid_floor(height), grid_wall(5)};
    grid_fixture_set_room(fixture, room, 2);
}

/* A floor at y = 1 and nobody on it. Where nothing is seen there is nothing. */
static int start(void **state)
{
    (void)state;
    rlf_world_def def = small_world_def();
    def.border = RLF_BORDER_OPEN;
    def.gravity = rlf_vec3_make(0, 9.81, 0);
    world = world_of(&def);
    set_floor(1);
    return 0;
}

/* The only body, a cube of 10 cm unless the test says otherwise. */
static const rlf_body_state *first(void)
{
    return body_at(world, 0);
}

static void put_cube(rlf_vec3 position)
{
    rlf_body_def def = rlf_body_def_default();
    def.position = position;
    add_body(world, &def);
}

/* Height of the next peak of the lowest point over the floor at y = 1. */
static double bounce_height(rlf_shape_type type, double restitution)
{
    const double DROP = 0.8;
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = type;
    def.shape.radius = 0.05;
    def.shape.height = type == RLF_SHAPE_CAPSULE ? 0.08 : 0.1;
    double half = type == RLF_SHAPE_CAPSULE ? 0.09 : 0.05;
    def.restitution = restitution;
    def.position = rlf_vec3_make(0.05, 1 - half - DROP, 2.5);
    add_body(world, &def);
    double peak = -1;
    bool is_up = false;
    for (int k = 0; k < 400; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 240);
        is_up = is_up || first()->velocity.y < 0;
        double height = 1 - half - first()->T_world_body.p.y;
        peak = is_up ? rlf_max(peak, height) : peak;
        if (is_up && first()->velocity.y > 0) {
            break;
        }
    }
    rlf_world_reset(world);
    return peak / DROP;
}

TEST_CASE(bounces_to_the_square_of_restitution)
{
    const double values[] = {1, 0.8, 0.5};
    for (int type = 0; type < 4; type++) {
        for (int i = 0; i < 3; i++) {
            double ratio = bounce_height((rlf_shape_type)type, values[i]);
            assert_less(fabs(ratio / (values[i] * values[i]) - 1), 0.02);
        }
    }
}

/* A blow is told at the place where they met, not where the body is at the end of the frame. */
TEST_CASE(blows_are_told_where_they_were)
{
    const double HEIGHT = 0.103, RADIUS = 0.05, FRAME = 1.0 / 30;
    int32_t blows = 0;
    rlf_world_set_gravity(world, rlf_vec3_make(0, 0, 0));
    for (int type = 0; type < 2; type++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape.type = type == 0 ? RLF_SHAPE_SPHERE : RLF_SHAPE_BOX;
        def.shape.radius = RADIUS;
        def.shape.size = rlf_vec3_make(2 * RADIUS, 2 * RADIUS, 2 * RADIUS);
        def.friction = 0.0;
        def.restitution = 1.0;
        def.position = rlf_vec3_make(-0.2, 1 - RADIUS - HEIGHT, 2.5);
        def.velocity = rlf_vec3_make(1.5, 2.0, 0.0);
        add_body(world, &def);
        for (int k = 0; k < 6; k++) {
            rlf_world_advance(world, &fixture->grid, FRAME);
            const rlf_snapshot *s = rlf_world_get_snapshot(world);
            for (int32_t i = 0; i < s->contact_count; i++) {
                const rlf_contact *c = &s->contacts[i];
                double aside = c->point.x - (def.position.x + 0.75 * HEIGHT);
                assert_true(fabs(c->point.y - 1.0) < 2e-4);
                assert_true(fabs(aside) < (type == 0 ? 2e-4 : RADIUS + 2e-4));
                assert_true(fabs(c->approach_speed - 2.0) < 1e-2);
                blows++;
            }
        }
        rlf_world_reset(world);
    }
    assert_true(blows >= 2);
}

TEST_CASE(rests_without_drift_and_sleeps)
{
    put_cube(rlf_vec3_make(0.1, 0.9, 2.5));
    double deepest = 0;
    for (int k = 0; k < 300; k++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        deepest = rlf_max(deepest, first()->T_world_body.p.y - 0.95);
    }
    rlf_vec3 p = first()->T_world_body.p;
    assert_true(first()->is_asleep);
    assert_less(hypot(p.x - 0.1, p.z - 2.5), 1e-4);
    assert_less(deepest, 1e-3);
}

/* The floor vanishes under a sleeper: it falls within 4 frames. */
TEST_CASE(falls_when_support_goes)
{
    put_cube(rlf_vec3_make(0.1, 0.949, 2.5));
    advance_steps(world, &fixture->grid, 60, 1.0 / 30);
    assert_true(first()->is_asleep);
    set_floor(1.4);
    fixture->grid.time_ns++;
    double before = first()->T_world_body.p.y;
    advance_steps(world, &fixture->grid, 4, 1.0 / 30);
    assert_true(first()->T_world_body.p.y > before + 0.05);
}

/* What stays has a number: a sleeper over the same one stays asleep where it is, and falls when a
 * new one has no floor under it. */
TEST_CASE(numbered_floor_goes)
{
    put_cube(rlf_vec3_make(0.1, 0.949, 2.5));
    rlf_vec3 slept = {0, 0, 0};
    for (int k = 0; k < 90; k++) {
        fixture->grid.background.version = 7;
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        slept = k == 60 ? first()->T_world_body.p : slept;
    }
    rlf_vec3 p = first()->T_world_body.p;
    assert_true(first()->is_asleep);
    assert_true(p.x == slept.x && p.y == slept.y && p.z == slept.z);
    set_floor(1.4);
    fixture->grid.background.version = 8;
    advance_frames(world, &fixture->grid, 4, 1.0 / 30);
    assert_true(first()->T_world_body.p.y > p.y + 0.05);
    fixture->grid.background.version = 0;
}

/* Holes smaller than a body do not swallow or stop it; a missing region is free space. */
TEST_CASE(missing_pixels)
{
    uint32_t seed = 1;
    for (int i = 0; i < GRID_W * GRID_H; i++) {
        seed = seed * 1664525u + 1013904223u;
        if ((seed >> 16) % 10 < 3) {
            fixture->planes[2][i] = 0;
        }
    }
    rlf_body_def def = rlf_body_def_default();
    def.restitution = 0;
    def.friction = 0.1;
    def.position = rlf_vec3_make(-0.8, 0.949, 2.5);
    def.velocity = rlf_vec3_make(1.5, 0, 0);
    add_body(world, &def);
    advance_steps(world, &fixture->grid, 30, 1.0 / 30);
    rlf_vec3 p = first()->T_world_body.p;
    double slid = 1.5 - 0.5 * 0.981;
    assert_less(fabs(p.y - 0.95), 2e-3);
    assert_less(fabs(p.x + 0.8 - slid), 0.05);
    memset(fixture->planes[2], 0, sizeof(float) * GRID_W * GRID_H);
    fixture->grid.time_ns++;
    advance_steps(world, &fixture->grid, 10, 1.0 / 30);
    assert_less(1.3, first()->T_world_body.p.y);
}

/* Raw sensor noise, new in every frame: the cube hardly moves, falls asleep and stays so. */
TEST_CASE(rests_on_a_noisy_floor)
{
    set_floor(1.2);
    put_cube(rlf_vec3_make(0.1, 1.14, 2.2));
    float *clean = malloc(sizeof(float) * GRID_W * GRID_H);
    memcpy(clean, fixture->planes[2], sizeof(float) * GRID_W * GRID_H);
    uint64_t seed = 11;
    double sum = 0, square = 0;
    int asleep_at = -1, wakes = 0;
    bool was_asleep = false;
    for (int k = 0; k < 300; k++) {
        for (int i = 350 * GRID_W; i < GRID_W * GRID_H; i++) {
            double z = clean[i];
            fixture->planes[2][i] = (float)(z + (0.0008 + 0.0003 * z * z) * draw_normal(&seed));
        }
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        bool is_asleep = first()->is_asleep;
        asleep_at = is_asleep && asleep_at < 0 ? k : asleep_at;
        wakes += was_asleep && !is_asleep;
        was_asleep = is_asleep;
        if (k >= 8) { /* it has landed; sleep comes later */
            double y = first()->T_world_body.p.y - 1.15;
            sum += y / 292;
            square += y * y / 292;
        }
    }
    double rms = sqrt(rlf_max(square - sum * sum, 0));
    assert_less(rms, 0.5e-3);
    assert_less(fabs(sum), 2e-3);
    assert_true(asleep_at >= 0 && asleep_at < 90);
    assert_int_equal(wakes, 0);
    free(clean);
}

/* A toy that stands on seven vertices, none of them quite as low as another. */
static const turned_ring ROUND_BOTTOM[5] = {
    {0.0404, 0.022}, {0.0374, 0.034}, {0.01, 0.045}, {-0.02, 0.04}, {-0.05, 0.015}};

/* A body whose bottom is round, on a floor that is rough but never changes, stops rocking. */
TEST_CASE(a_round_bottom_comes_to_rest)
{
    uint64_t seed = 5;
    for (int i = 250 * GRID_W; i < GRID_W * GRID_H; i++) {
        fixture->planes[2][i] += (float)(0.001 * draw_normal(&seed));
    }
    turned_hull toy;
    turned_hull_make(&toy, ROUND_BOTTOM, 5, 7);
    for (int s = 0; s < 7; s++) {
        toy.vertices[s].y += 0.0002 * (s * 3 % 7 - 3);
    }
    int awake = 0;
    for (int k = 0; k < 12; k++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape.type = RLF_SHAPE_HULL;
        def.shape.hull = &toy.hull;
        def.mass = 0.05;
        def.friction = 0.8;
        def.restitution = 0.1;
        def.position = rlf_vec3_make(0.05 * k - 0.3, 0.95, 1.9);
        def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0.1, 0.5 * k, 0.05));
        add_body(world, &def);
        advance_frames(world, &fixture->grid, 120, 1.0 / 30);
        awake += !first()->is_asleep;
        rlf_world_reset(world);
    }
    print_message("round bottoms on a rough floor: %d of 12 awake after 4 s\n", awake);
    assert_int_equal(awake, 0);
}

/* A camera that is mounted askew: the grid's frame is not the world's. */
TEST_CASE(rests_under_a_tilted_camera)
{
    rlf_pose mount = {{0.5, -1, 0.3}, rlf_quat_from_axis_angle(rlf_vec3_make(1, 0, 0), 0.4)};
    fixture->grid.T_world_grid = mount;
    rlf_world_set_gravity(world, rlf_rotate(mount.q, rlf_vec3_make(0, 9.81, 0)));
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_transform(&mount, rlf_vec3_make(0.1, 0.8, 2.4));
    def.orientation = mount.q;
    add_body(world, &def);
    advance_frames(world, &fixture->grid, 90, 1.0 / 30);
    rlf_vec3 p = rlf_transform_inverse(&mount, first()->T_world_body.p);
    assert_true(fabs(p.y - 0.95) < 1e-3 && fabs(p.x - 0.1) < 1e-3 && fabs(p.z - 2.4) < 1e-3);
    assert_true(first()->is_asleep);
    fixture->grid.T_world_grid = rlf_pose_identity();
}

/* Inside the wall at the start: comes out at bounded speed. */
TEST_CASE(comes_out_of_the_wall)
{
    rlf_body_def def = rlf_body_def_default();
    def.position = rlf_vec3_make(0.1, 0.9, 5.15);
    def.orientation = rlf_quat_from_axis_angle(rlf_normalize(rlf_vec3_make(1, 2, 3)), 1);
    add_body(world, &def);
    double fastest = 0;
    for (int k = 0; k < 90; k++) {
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        fastest = rlf_max(fastest, rlf_length(first()->velocity));
    }
    assert_true(fastest < 4);
    assert_true(first()->T_world_body.p.z < 5);
    assert_true(first()->T_world_body.p.y < 1);
}

TEST_GROUP(set_up, tear_down)
TEST_EACH(start, stop_world)
