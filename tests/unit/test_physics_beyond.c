/* What the picture's border cuts goes on beyond it: a leg down to the floor, a cupboard's front. */
#include "grid_room.h"
#include "test.h"

#define LEG_Z 1.5
#define LEG_SIDE 0.03
#define RADIUS 0.04
#define START (-0.3)
#define FRONT_Z 1.5
#define FRONT_PIXELS 60

static void paint(int32_t last_row)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        double x = LEG_Z * grid_room_ray(i).x;
        if (x > -LEG_SIDE && x < LEG_SIDE && i / GRID_W <= last_row) {
            grid_room_paint(i, LEG_Z, rlf_vec3_make(0, 0, -1));
        }
    }
}

/* Where a body is that slides across the floor below the picture for half a second. */
static double slide(rlf_shape_type type, double z)
{
    double u, v;
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = type, .radius = RADIUS};
    def.shape.size = rlf_vec3_make(2 * RADIUS, 2 * RADIUS, 2 * RADIUS);
    def.position = rlf_vec3_make(START, grid_room_down * (GRID_ROOM_FLOOR - RADIUS - 0.002), z);
    def.velocity = rlf_vec3_make(1.5, 0, 0);
    def.friction = 0.0;
    def.restitution = 0.0;
    assert_false(grid_fixture_project(NULL, def.position, &u, &v));
    const grid_room_way way = grid_room_run(RLF_BORDER_EXTEND, &def, 15);
    assert_true(way.is_there && grid_room_down * way.p.y < GRID_ROOM_FLOOR);
    return way.p.x;
}

static void expect_leg(double z)
{
    assert_true(slide(RLF_SHAPE_SPHERE, z) < -LEG_SIDE - RADIUS + 0.01);
    assert_true(slide(RLF_SHAPE_BOX, z) < -LEG_SIDE - RADIUS + 0.01);
}

static void expect_air(double z)
{
    assert_true(slide(RLF_SHAPE_SPHERE, z) > 0.3);
    assert_true(slide(RLF_SHAPE_BOX, z) > 0.3);
}

TEST_CASE(leg_goes_on_below_the_picture)
{
    paint(GRID_H);
    expect_leg(LEG_Z + 0.02);
    expect_air(LEG_Z - 0.1);
}

/* Below what ends in the picture bodies pass. */
TEST_CASE(what_hangs_does_not)
{
    paint(GRID_H - 8);
    expect_air(LEG_Z + 0.02);
}

/* What is down decides, and not which of the picture's borders is the lower one. */
TEST_CASE(a_camera_may_hang_upside_down)
{
    paint(GRID_H);
    grid_room_turn_over();
    expect_leg(LEG_Z + 0.02);
    expect_air(LEG_Z - 0.1);
    paint(GRID_H - 8);
    grid_room_turn_over();
    expect_air(LEG_Z + 0.02);
}

enum { LEFT, RIGHT, TOP, SIDES };

/* How many pixels are between pixel i and that border. */
static int32_t inward(int32_t i, int side)
{
    return side == TOP ? i / GRID_W : side == LEFT ? i % GRID_W : GRID_W - 1 - i % GRID_W;
}

/* A front at that border, that begins so many pixels from it. */
static void paint_front(int side, int32_t first)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        if (inward(i, side) >= first && inward(i, side) < FRONT_PIXELS) {
            grid_room_paint(i, FRONT_Z, rlf_vec3_make(0, 0, -1));
        }
    }
}

/* The farthest z of a body that flies at such a front for half a second, `beside` m out of view; if
 * that is negative, in view when it comes to the front. */
static double fly_at(rlf_shape_type type, int side, double beside)
{
    double u, v;
    rlf_vec3 low = rlf_scale(grid_room_ray(0), FRONT_Z);
    rlf_vec3 high = rlf_scale(grid_room_ray(GRID_W - 1), FRONT_Z);
    const rlf_vec3 start[SIDES] = {{low.x - beside, 0.0, FRONT_Z - 0.3},
                                   {high.x + beside, 0.0, FRONT_Z - 0.3},
                                   {0.0, low.y - beside, FRONT_Z - 0.3}};
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = type, .radius = RADIUS};
    def.shape.size = rlf_vec3_make(2 * RADIUS, 2 * RADIUS, 2 * RADIUS);
    def.position = start[side];
    def.velocity = rlf_vec3_make(0, 0, 3.0);
    def.gravity_scale = 0.0;
    def.restitution = 0.0;
    assert_true(beside < 0.0 || !grid_fixture_project(NULL, def.position, &u, &v));
    const grid_room_way way = grid_room_run(RLF_BORDER_EXTEND, &def, 15);
    assert_true(way.is_there);
    return way.farthest_z;
}

static void expect_front(int side, double beside)
{
    assert_true(fly_at(RLF_SHAPE_SPHERE, side, beside) < FRONT_Z - RADIUS + 0.01);
    assert_true(fly_at(RLF_SHAPE_BOX, side, beside) < FRONT_Z - RADIUS + 0.01);
}

static void expect_no_front(int side, double beside)
{
    assert_true(fly_at(RLF_SHAPE_SPHERE, side, beside) > FRONT_Z + 0.5);
    assert_true(fly_at(RLF_SHAPE_BOX, side, beside) > FRONT_Z + 0.5);
}

TEST_CASE(a_front_goes_on_beyond_the_picture)
{
    for (int side = 0; side < SIDES; side++) {
        paint_front(side, 0);
        expect_front(side, 0.1);
        expect_no_front(side, 0.5); /* nobody knows */
    }
}

TEST_CASE(what_ends_before_the_border_does_not)
{
    for (int side = 0; side < SIDES; side++) {
        paint_front(side, 8);
        expect_no_front(side, 0.1);
    }
}

/* Nothing is seen up to so many pixels from that border, and a front beside them. */
static void paint_ring(int side, int32_t width)
{
    grid_room_create();
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) {
        if (inward(i, side) < width) {
            grid_room_paint(i, 0.0, rlf_vec3_make(0, 0, 0));
        } else if (inward(i, side) < width + FRONT_PIXELS) {
            grid_room_paint(i, FRONT_Z, rlf_vec3_make(0, 0, -1));
        }
    }
}

TEST_CASE(a_front_goes_on_in_a_ring)
{
    const int32_t RING = 40;
    for (int side = 0; side < SIDES; side++) {
        paint_ring(side, RING);
        for (int32_t k = -10; k <= RING + 5; k += 5) {
            expect_front(side, -k * FRONT_Z / GRID_F);
        }
    }
}

/* Nobody knows whether it is a thing that ends there that is seen before what is too far. */
TEST_CASE(a_front_ends_at_a_hole)
{
    for (int side = 0; side < SIDES; side++) {
        paint_ring(side, 75);
        expect_no_front(side, -0.12);
    }
}

TEST_CASE(without_a_background_all_is_free)
{
    grid_room_create();
    grid_room->grid.background.depth = NULL;
    expect_no_front(LEFT, 0.1);
    expect_no_front(LEFT, -0.1);
}

/* The floor is level about 3 m from the camera, and rises towards it by that slope. */
static void set_floor(double slope)
{
    const rlf_vec3 n = rlf_normalize(rlf_vec3_make(0, -1, slope));
    grid_plane planes[2] = {grid_floor(GRID_ROOM_FLOOR), grid_wall(GRID_ROOM_WALL)};
    planes[0] = (grid_plane){n, rlf_dot(n, rlf_vec3_make(0, GRID_ROOM_FLOOR, 3))};
    grid_fixture_set_room(grid_room, planes, 2);
    grid_room->grid.background.version++;
}

/* The floor as it is fitted again goes on 24 mm higher where a body rests out of view. */
TEST_CASE(a_new_fit_throws_nothing)
{
    const double SLOPE = 0.011, MOST = 0.0015;
    rlf_world_def world_def = small_world_def();
    world_def.border = RLF_BORDER_EXTEND;
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_BOX, .size = {0.1, 0.1, 0.1}};
    def.position = rlf_vec3_make(0.0, GRID_ROOM_FLOOR - 0.052, 0.8);
    rlf_world *world = NULL;
    grid_room_create();
    set_floor(0.0);
    world = world_of(&world_def);
    add_body(world, &def);
    double before = 0.0, first = 0.0, y = 0.0;
    for (int k = 0; k < 300; k++) {
        if (k == 30) {
            set_floor(SLOPE);
        }
        grid_room->grid.time_ns++;
        rlf_world_set_gravity(world, world_def.gravity); /* nothing sleeps */
        rlf_world_advance(world, &grid_room->grid, GRID_ROOM_FRAME);
        y = rlf_world_get_snapshot(world)->bodies[0].T_world_body.p.y;
        first = k == 29 ? y : first;
        assert_true(k < 30 || (y < before + MOST && y > before - MOST));
        before = y;
    }
    assert_true(y < first - 0.02 && y > first - 0.028);
    rlf_world_destroy(&world);
}

TEST_EACH(NULL, grid_room_destroy)
