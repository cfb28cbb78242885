/* Bodies against bodies, live method. */
#include "each_world.h"
#include "test.h"
#include "grid_fixture.h"

#include <math.h>

static rlf_body_def body_of(rlf_shape_type type)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = type;
    def.shape.radius = 0.05;
    def.shape.height = 0.1;
    def.restitution = 1;
    return def;
}

/* Equal masses, e = 1: velocities are exchanged. */
TEST_CASE(head_on_swaps)
{
    const rlf_shape_type types[] = {RLF_SHAPE_SPHERE, RLF_SHAPE_BOX, RLF_SHAPE_CAPSULE,
                                    RLF_SHAPE_CYLINDER};
    for (size_t i = 0; i < 4; i++) {
        no_gravity();
        rlf_body_def def = body_of(types[i]);
        def.position = rlf_vec3_make(-0.3, 0, 1);
        def.velocity = rlf_vec3_make(1.5, 0, 0);
        add_body(world, &def);
        def.position = rlf_vec3_make(0.3, 0, 1);
        def.velocity = rlf_vec3_make(-0.5, 0, 0);
        add_body(world, &def);
        advance_steps(world, NULL, 20, 1.0 / 30);
        assert_less(fabs(body_at(world, 0)->velocity.x + 0.5), 1e-3);
        assert_less(fabs(body_at(world, 1)->velocity.x - 1.5), 1e-3);
        double turn = rlf_length(body_at(world, 0)->angular_velocity);
        assert_less(turn, 1e-6);
        rlf_world_reset(world);
    }
}

/* Any off-centre collision keeps momentum, and energy does not grow. */
/* Balls in free space swap their speeds, however slow they are. */
TEST_CASE(slow_balls_swap)
{
    no_gravity();
    rlf_body_def def = body_of(RLF_SHAPE_SPHERE);
    def.position = rlf_vec3_make(-0.06, 0, 1);
    def.velocity = rlf_vec3_make(0.1, 0, 0);
    add_body(world, &def);
    def.position.x = 0.06;
    def.velocity.x = 0;
    add_body(world, &def);
    advance_steps(world, NULL, 30, 1.0 / 30);
    assert_true(fabs(body_at(world, 0)->velocity.x) < 1e-3);
    assert_true(fabs(body_at(world, 1)->velocity.x - 0.1) < 1e-3);
}

/* A cube that lies on another rests however bouncy it is: what meets there is no faster than what
 * gravity gives in a few substeps. */
TEST_CASE(slow_cube_rests)
{
    rlf_body_def def = body_of(RLF_SHAPE_BOX);
    def.shape.size = rlf_vec3_make(2, 0.1, 2);
    def.is_kinematic = true;
    def.position = rlf_vec3_make(0, 1, 0);
    add_body(world, &def);
    def = body_of(RLF_SHAPE_BOX);
    def.position = rlf_vec3_make(0, 0.9, 0);
    add_body(world, &def);
    advance_steps(world, NULL, 10, 1.0 / 60);
    def.position.y = 0.7995;
    def.velocity = rlf_vec3_make(0, 0.03, 0);
    add_body(world, &def);
    double rise = 0;
    for (int k = 0; k < 240; k++) {
        rlf_world_advance(world, NULL, 1.0 / 240);
        double height = 0.8 - body_at(world, 2)->T_world_body.p.y;
        rise = k >= 24 ? rlf_max(rise, height) : 0.0; /* it started above */
    }
    assert_less(rise, 2e-4);
}

TEST_CASE(momentum_is_conserved)
{
    static const rlf_vec3 corners[4] = {
        {-0.05, 0.05, -0.05}, {0.05, 0.05, -0.05}, {0, 0.05, 0.1}, {0, -0.15, 0}};
    static const int32_t triangles[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    rlf_hull hull = {corners, 4, triangles, 4};
    for (int first = 0; first < 5; first++) {
        for (int second = 0; second < 5; second++) {
            no_gravity();
            rlf_body_def a = body_of((rlf_shape_type)first), b = body_of((rlf_shape_type)second);
            a.shape.hull = b.shape.hull = &hull;
            a.mass = 0.2;
            a.position = rlf_vec3_make(-0.3, 0.02, 1.01);
            a.velocity = rlf_vec3_make(3, 0, 0);
            a.angular_velocity = rlf_vec3_make(1, 2, 3);
            b.position = rlf_vec3_make(0, 0, 1);
            add_body(world, &a);
            add_body(world, &b);
            double energy = rlf_world_energy(world);
            int touched = 0;
            for (int k = 0; k < 20; k++) {
                rlf_world_advance(world, NULL, 1.0 / 30);
                touched += rlf_world_get_snapshot(world)->contact_count;
            }
            rlf_vec3 p = rlf_add(rlf_scale(body_at(world, 0)->velocity, 0.2),
                                 rlf_scale(body_at(world, 1)->velocity, 0.1));
            assert_true(touched > 0);
            assert_true(fabs(p.x - 0.6) < 1e-9 && fabs(p.y) < 1e-9 && fabs(p.z) < 1e-9);
            double gain = rlf_world_energy(world) / energy - 1;
            if (gain > 0.01) {
                print_message("shapes %d %d: energy %+.4f\n", first, second, gain);
            }
            assert_true(gain < 0.01);
            rlf_world_reset(world);
        }
    }
}

/* What may overlap is a share of the smaller body: a wide ground swallows nothing. */
TEST_CASE(a_wide_ground_holds)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(10, 1, 10);
    def.position = rlf_vec3_make(0, 0.5, 0);
    def.is_kinematic = true;
    add_body(world, &def);
    def = rlf_body_def_default();
    def.position = rlf_vec3_make(0, -0.05, 0);
    add_body(world, &def);
    advance_steps(world, NULL, 60, 1.0 / 30);
    double depth = body_at(world, 1)->T_world_body.p.y + 0.05;
    assert_less(depth, 0.5e-3);
}

/* More pairs at one body than the solver has colours for: 81 cubes on a plate, which stands on a
 * grid. */
TEST_CASE(a_plate_carries_many)
{
    grid_fixture *f = grid_fixture_create();
    grid_plane room[2] = {grid_floor(1.0), grid_wall(4)};
    grid_fixture_set_room(f, room, 2);
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(1.2, 0.06, 1.2);
    def.mass = 20.0;
    def.position = rlf_vec3_make(0.0, 0.97, 2.8);
    add_body(world, &def);
    def = rlf_body_def_default();
    def.restitution = 0.0;
    for (int i = 0; i < 81; i++) {
        def.position = rlf_vec3_make(0.13 * (i % 9 - 4), 0.88, 2.8 + 0.13 * (i / 9 - 4));
        add_body(world, &def);
    }
    for (int k = 0; k < 90; k++) {
        f->grid.time_ns = k;
        rlf_world_advance(world, &f->grid, 1.0 / 30);
    }
    for (int i = 1; i <= 81; i++) {
        rlf_vec3 p = body_at(world, i)->T_world_body.p;
        assert_float_equal(p.y, 0.89, 2e-3);
        assert_float_equal(p.x, 0.13 * ((i - 1) % 9 - 4), 5e-3);
    }
    grid_fixture_destroy(&f);
}

TEST_CASE(bodies_may_ignore_bodies)
{
    no_gravity();
    rlf_body_def def = body_of(RLF_SHAPE_BOX);
    def.collides_with_bodies = false;
    def.position = rlf_vec3_make(-0.3, 0, 1);
    def.velocity = rlf_vec3_make(2, 0, 0);
    rlf_world_add_body(world, &def, NULL);
    def.collides_with_bodies = true;
    def.position = rlf_vec3_make(0, 0, 1);
    def.velocity = rlf_vec3_make(0, 0, 0);
    rlf_world_add_body(world, &def, NULL);
    advance_steps(world, NULL, 20, 1.0 / 30);
    assert_true(body_at(world, 0)->velocity.x == 2.0);
    assert_true(body_at(world, 1)->velocity.x == 0.0);
}

TEST_EACH(start_world, stop_world)
