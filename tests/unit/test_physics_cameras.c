/* One world that two cameras see: what one of them shows counts, what the other only guesses does
 * not. They face each other across a room, 4 m apart. */
#include "created.h"
#include "test.h"

#include "count_assert.h"
#include "grid_fixture.h"

#include <math.h>

#define FRAME (1.0 / 30)
#define APART 4.0
#define FRONT 1.9 /* of a board between them, from the first; */
#define BACK 2.1  /* its other face, which only the second sees */

static grid_fixture *near_side, *far_side;

static int set_up(void **state)
{
    (void)state;
    near_side = grid_fixture_create();
    far_side = grid_fixture_create();
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    grid_fixture_destroy(&near_side);
    grid_fixture_destroy(&far_side);
    return 0;
}

static const rlf_vec3 still = {0, 0, 0};

/* The floor is 1 m below both; each sees a wall behind the other. The board is 1 m wide, and the
 * first takes it for `guess` thick. */
static void set_room(double guess)
{
    const grid_plane room[2] = {grid_floor(1.0), grid_wall(APART + 1.0)};
    const rlf_vec3 size = {0.5, 0.95, 0}; /* it does not reach the floor */
    const rlf_quat turned = rlf_quat_from_axis_angle(rlf_vec3_make(0, 1, 0), RLF_PI);
    grid_fixture_set_room(near_side, room, 2);
    grid_fixture_set_room(far_side, room, 2);
    grid_fixture_set_slab(near_side, grid_wall(FRONT), still, size, guess, still);
    grid_fixture_set_slab(far_side, grid_wall(APART - BACK), still, size, guess, still);
    far_side->grid.T_world_grid = (rlf_pose){{0, 0, APART}, turned};
    far_side->grid.camera = 1;
}

static rlf_world *make_world(const rlf_body_def *body, double gravity)
{
    rlf_world_def def = rlf_world_def_default();
    def.gravity = rlf_vec3_make(0, gravity, 0);
    def.body_capacity = 4;
    def.contact_capacity = 256;
    def.camera_capacity = 2;
    rlf_world *world = world_of(&def);
    add_body(world, body);
    return world;
}

static const rlf_body_state *first(const rlf_world *world)
{
    return &rlf_world_get_snapshot(world)->bodies[0];
}

static void advance(rlf_world *world, bool with_both)
{
    near_side->grid.time_ns++;
    far_side->grid.time_ns++;
    near_side->grid.next = with_both ? &far_side->grid : NULL;
    rlf_world_advance(world, &near_side->grid, FRAME);
    near_side->grid.next = NULL;
}

static rlf_body_def ball(double radius)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = RLF_SHAPE_SPHERE;
    def.shape.radius = radius;
    return def;
}

/* Where the ball, thrown at the board's far face, turns round: z of its nearest side. */
static double turns_at(double guess, bool with_both)
{
    rlf_body_def def = ball(0.05);
    def.position = rlf_vec3_make(0, 0.1, 3.2);
    def.velocity = rlf_vec3_make(0, 0, -3);
    set_room(guess);
    rlf_world *world = make_world(&def, 0.0);
    double least = 9.0;
    for (int k = 0; k < 30; k++) {
        advance(world, with_both);
        least = rlf_min(least, first(world)->T_world_body.p.z - def.shape.radius);
    }
    rlf_world_destroy(&world);
    return least;
}

TEST_CASE(a_back_is_where_the_other_camera_sees_it)
{
    for (int k = 0; k < 3; k++) {
        const double guess = 0.1 + 0.2 * k; /* too thin, and twice too thick */
        const double alone = turns_at(guess, false), both = turns_at(guess, true);
        assert_true(fabs(both - BACK) < 0.11); /* 3 m/s between two frames */
        assert_true(k == 0 || alone > FRONT + guess - 0.02);
    }
}

/* The floor behind the board, which hides it from the first. */
TEST_CASE(a_ball_rests_on_what_only_the_second_sees)
{
    rlf_body_def def = ball(0.05);
    def.position = rlf_vec3_make(0.1, 0.5, 2.25);
    set_room(0.8);
    rlf_world *world = make_world(&def, 9.81);
    for (int k = 0; k < 90; k++) {
        advance(world, true);
    }
    assert_float_equal(first(world)->T_world_body.p.y, 0.95, 0.002);
    assert_float_equal(first(world)->T_world_body.p.z, 2.25, 0.01);
    assert_true(first(world)->is_asleep);
    rlf_world_destroy(&world);
}

/* In the same place the first camera alone takes the body to be inside of the board. */
TEST_CASE(the_first_alone_pushes_it_out)
{
    rlf_body_def def = ball(0.05);
    def.position = rlf_vec3_make(0.1, 0.5, 2.9);
    def.velocity = rlf_vec3_make(0, 0, -0.5);
    set_room(0.8);
    rlf_world *world = make_world(&def, 0.0);
    double least = 9.0;
    for (int k = 0; k < 60; k++) {
        advance(world, false);
        least = rlf_min(least, first(world)->T_world_body.p.z);
    }
    assert_true(least > FRONT + 0.8 + 0.03);
    rlf_world_destroy(&world);
}

/* What both see of one floor is one floor: a crate lies on it as on one camera's. */
TEST_CASE(one_floor_seen_twice_is_one)
{
    double heights[2];
    for (int both = 0; both < 2; both++) {
        rlf_body_def def = rlf_body_def_default();
        def.position = rlf_vec3_make(1.0, 0.6, 2.0);
        def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0.2, 0.3, 0.1));
        set_room(0.1);
        rlf_world *world = make_world(&def, 9.81);
        for (int k = 0; k < 90; k++) {
            advance(world, both != 0);
        }
        heights[both] = first(world)->T_world_body.p.y;
        assert_true(first(world)->is_asleep);
        rlf_world_destroy(&world);
    }
    print_message("a crate on the floor: %.5f m by one camera, %.5f by both\n", heights[0],
                  heights[1]);
    assert_float_equal(heights[0], 0.95, 0.001);
    assert_float_equal(heights[1], 0.95, 0.001);
}

/* A camera that goes and comes back: what only it saw goes, too, and a sleeper wakes. */
TEST_CASE(a_camera_that_goes_takes_its_floor_along)
{
    rlf_body_def def = ball(0.05);
    def.position = rlf_vec3_make(0.1, 0.9, 2.25);
    set_room(0.1);
    memset(near_side->planes[2], 0, sizeof(float) * GRID_W * GRID_H); /* it sees nothing */
    memset(near_side->mask, 0, (size_t)GRID_W * GRID_H);
    rlf_world *world = make_world(&def, 9.81);
    for (int k = 0; k < 60; k++) {
        advance(world, true);
    }
    assert_true(first(world)->is_asleep);
    for (int k = 0; k < 15; k++) {
        advance(world, false);
    }
    assert_true(first(world)->T_world_body.p.y > 1.1);
    rlf_world_destroy(&world);
}

/* Two grids of one camera, or more cameras than there is room for, are the caller's mistake. */
TEST_CASE(lists_that_are_wrong_are_told)
{
    const rlf_body_def def = ball(0.05);
    int told = 0;
    set_room(0.1);
    rlf_world *world = make_world(&def, 9.81);
    const rlf_vec3 before = first(world)->T_world_body.p;
    rlf_set_assert(count_assert, &told);
    const int32_t wrong[3] = {0, 2, -1};
    for (int k = 0; k < 3; k++) {
        far_side->grid.camera = wrong[k];
        advance(world, true);
    }
    rlf_set_assert(NULL, NULL);
    assert_int_equal(told, 3);
    assert_true(first(world)->T_world_body.p.y == before.y);
    rlf_world_destroy(&world);
}

TEST_GROUP(set_up, tear_down)
