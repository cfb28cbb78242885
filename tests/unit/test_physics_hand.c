/* A sensed hand that carries a stack along a curve, and a crowd that somebody walks through. */
#include "each_world.h"
#include "test.h"
#include "grid_shared.h"

#include <math.h>

#define FRAME (1.0 / 30)
#define CROWD 100

/* The palm, 40 x 40 cm, on a circle of 0.3 m at `speed`, seen at time t. */
static rlf_vec3 see_palm(double t, double speed)
{
    const double RADIUS = 0.3;
    double angle = speed / RADIUS * t;
    rlf_vec3 centre = rlf_vec3_make(RADIUS * rlf_sin(angle), 0.8, 2.3 - RADIUS * rlf_cos(angle));
    rlf_vec3 velocity = rlf_vec3_make(speed * rlf_cos(angle), 0, speed * rlf_sin(angle));
    grid_fixture_set_slab(fixture, grid_floor(centre.y), centre, rlf_vec3_make(0.2, 0, 0.2), 0.05,
                          velocity);
    fixture->grid.time_ns++;
    return centre;
}

/* CARRY: three stacked cubes on a hand that moves at 0.5 m/s along a circle stay where they are on
 * it. */
TEST_CASE(hand_carries_a_stack)
{
    grid_plane room[2] = {grid_floor(1.2), grid_wall(5)};
    grid_fixture_set_room(fixture, room, 2);
    rlf_vec3 start = see_palm(0, 0.5);
    for (int k = 0; k < 3; k++) {
        rlf_body_def def = rlf_body_def_default();
        def.restitution = 0;
        def.velocity = rlf_vec3_make(0.5, 0, 0);
        def.position = rlf_vec3_make(start.x, start.y - 0.05 - 0.1 * k, start.z);
        add_body(world, &def);
    }
    double worst = 0;
    for (int frame = 1; frame <= 120; frame++) {
        rlf_vec3 palm = see_palm(frame * FRAME, 0.5);
        rlf_world_advance(world, &fixture->grid, FRAME);
        for (int k = 0; k < 3; k++) {
            rlf_vec3 p = rlf_world_get_snapshot(world)->bodies[k].T_world_body.p;
            rlf_vec3 place = rlf_vec3_make(palm.x, palm.y - 0.05 - 0.1 * k, palm.z);
            worst = rlf_max(worst, rlf_length(rlf_sub(p, place)));
        }
    }
    assert_less(worst, 0.03);
}

/* A board comes to a sleeping cube at 2.5 m/s, 8 cm a frame, whatever part of its way is left when
 * the frame begins in which it touches: it never passes. */
TEST_CASE(board_wakes_a_sleeper_in_time)
{
    const double SPEED = 2.5, THICKNESS = 0.04;
    grid_plane room[2] = {grid_floor(1.2), grid_wall(5)};
    grid_fixture_set_room(fixture, room, 2);
    for (int phase = 0; phase < 8; phase++) {
        rlf_body_def def = rlf_body_def_default();
        def.position = rlf_vec3_make(0, 1.149, 2.8);
        add_body(world, &def);
        memset(fixture->mask, 0, (size_t)GRID_W * GRID_H);
        advance_frames(world, &fixture->grid, 45, FRAME);
        const rlf_body_state *cube = &rlf_world_get_snapshot(world)->bodies[0];
        assert_true(cube->is_asleep);
        double ahead = 1.0;
        for (double z = 2.4 + 0.01 * phase; z < 3.2; z += SPEED * FRAME) {
            grid_fixture_set_slab(fixture, grid_wall(z), rlf_vec3_make(0, 1.08, z),
                                  rlf_vec3_make(0.3, 0.1, 0), THICKNESS,
                                  rlf_vec3_make(0, 0, SPEED));
            fixture->grid.time_ns++;
            rlf_world_advance(world, &fixture->grid, FRAME);
            cube = &rlf_world_get_snapshot(world)->bodies[0];
            ahead = rlf_min(ahead, cube->T_world_body.p.z - z - THICKNESS);
        }
        assert_true(ahead > 0.045);
        rlf_world_reset(world);
    }
}

/* Floor, back wall and two side walls, all within the view. */
static const grid_plane ROOM[4] = {
    {{0, -1, 0}, -1.0}, {{0, 0, -1}, -4.5}, {{1, 0, 0}, -1.6}, {{-1, 0, 0}, -1.6}};

static bool is_lost(rlf_vec3 p)
{
    double u, v, worst = -1;
    for (int i = 0; i < 4; i++) {
        worst = rlf_max(worst, ROOM[i].d - rlf_dot(ROOM[i].n, p));
    }
    return worst > 0 && grid_fixture_project(NULL, p, &u, &v);
}

/* Somebody 50 cm wide and 25 cm deep walks from side to side at 1 m/s. Returns x of the middle. */
static double see_walker(double t)
{
    double phase = t / 2.4 - floor(t / 2.4);
    double direction = phase < 0.5 ? 1 : -1;
    double x = -1.2 / 2 + 1.2 * (phase < 0.5 ? 2 * phase : 2 - 2 * phase);
    grid_fixture_set_slab(fixture, grid_wall(2.9), rlf_vec3_make(x, 0.3, 2.9),
                          rlf_vec3_make(0.25, 0.7, 0), 0.25, rlf_vec3_make(direction, 0, 0));
    fixture->grid.time_ns++;
    return x;
}

/* CROWD: cubes fall while somebody walks through them; none gets out of the room in view, and none
 * stays inside the walker. */
TEST_CASE(crowd_survives_a_walker)
{
    grid_fixture_set_room(fixture, ROOM, 4);
    for (int i = 0; i < CROWD; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.position = rlf_vec3_make(-0.8 + 0.178 * (i % 10), 0.8 - 0.16 * (i / 20),
                                     i / 10 % 2 == 0 ? 2.8 : 3.25);
        def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0.1 * i, 0.2 * i, 0.3 * i));
        def.release_time = 0.02 * i;
        add_body(world, &def);
    }
    bool was_lost[CROWD] = {false};
    int lost = 0, inside = 0, longest = 0, touched = 0, stay[CROWD] = {0};
    for (int frame = 0; frame < 240; frame++) {
        double x = see_walker(frame * FRAME);
        rlf_world_advance(world, &fixture->grid, FRAME);
        const rlf_snapshot *s = rlf_world_get_snapshot(world);
        for (int32_t i = 0; i < s->contact_count; i++) {
            touched += s->contacts[i].other == RLF_CONTACT_FOREGROUND;
        }
        for (int32_t i = 0; i < s->body_count; i++) {
            rlf_vec3 p = s->bodies[i].T_world_body.p;
            uint32_t slot = s->bodies[i].id.index1 - 1;
            assert_true(rlf_vec3_is_finite(p));
            lost += is_lost(p) && !was_lost[slot];
            was_lost[slot] = was_lost[slot] || is_lost(p);
            bool is_in = fabs(p.x - x) < 0.2 && p.z > 2.92 && p.z < 3.13 && fabs(p.y - 0.3) < 0.65;
            stay[slot] = is_in && !s->bodies[i].is_held ? stay[slot] + 1 : 0;
            inside += stay[slot] == 1;
            longest = stay[slot] > longest ? stay[slot] : longest;
        }
    }
    print_message("CROWD: %d cubes, 8 s: %d lost, %d got inside the walker, for at most %d frames, "
                  "%d touches\n",
                  CROWD, lost, inside, longest, touched);
    assert_int_equal(lost, 0);
    assert_true(touched > 100); /* he did walk through them */
    assert_true(longest <= 3);
}

TEST_GROUP(set_up, tear_down)
TEST_EACH(start_world, stop_world)
