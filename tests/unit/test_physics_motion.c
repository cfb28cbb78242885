/* Free motion of the live method against closed forms. */
#include "each_world.h"
#include "test.h"

#include <math.h>

/* A body of half gravity falls half as far, one of none stays, one of less than none rises. */
TEST_CASE(each_falls_by_its_own_gravity)
{
    const double scales[] = {1, 0.5, 0, -0.25};
    assert_true(rlf_world_set_gravity(world, rlf_vec3_make(0, 9.81, 3)));
    for (int i = 0; i < 4; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.position = rlf_vec3_make(i, 0, 2);
        def.gravity_scale = scales[i];
        add_body(world, &def);
    }
    advance_steps(world, NULL, 30, 1.0 / 30);
    for (int i = 0; i < 4; i++) {
        const rlf_body_state *body = body_at(world, i);
        assert_true(body->T_world_body.p.x == i);
        assert_true(fabs(body->T_world_body.p.y - scales[i] * 0.5 * 9.81) <= 1e-9);
        assert_true(fabs(body->T_world_body.p.z - 2 - scales[i] * 0.5 * 3) <= 1e-9);
        assert_true(fabs(body->velocity.y - scales[i] * 9.81) <= 1e-9);
    }
}

TEST_CASE(projectile_and_energy)
{
    rlf_body_def def = rlf_body_def_default();
    def.velocity = rlf_vec3_make(2, -3, 1);
    def.position = rlf_vec3_make(-1, 0.5, 1);
    add_body(world, &def);
    double energy = rlf_world_energy(world);
    advance_steps(world, NULL, 20, 1.0 / 30);
    double t = 20.0 / 30;
    rlf_vec3 p = body_at(world, 0)->T_world_body.p;
    assert_true(fabs(p.x - (-1 + 2 * t)) < 1e-9);
    assert_true(fabs(p.y - (0.5 - 3 * t + 0.5 * 9.81 * t * t)) < 1e-9);
    assert_true(fabs(p.z - (1 + t)) < 1e-9);
    assert_true(fabs(rlf_world_energy(world) - energy) < 1e-9);
}

TEST_CASE(force_acts_for_one_advance)
{
    no_gravity();
    rlf_body_def def = rlf_body_def_default();
    def.mass = 2;
    rlf_body_id id = add_body(world, &def);
    assert_true(rlf_world_apply_force(world, id, rlf_vec3_make(6, 0, 0), def.position));
    rlf_world_advance(world, NULL, 0.5);
    assert_true(fabs(body_at(world, 0)->velocity.x - 1.5) < 1e-12);
    assert_true(fabs(body_at(world, 0)->T_world_body.p.x - 0.5 * 3 * 0.25) < 1e-12);
    rlf_world_advance(world, NULL, 0.5);
    assert_true(fabs(body_at(world, 0)->velocity.x - 1.5) < 1e-12);
}

TEST_CASE(impulse_turns_and_moves)
{
    no_gravity();
    rlf_body_def def = rlf_body_def_default(); /* 0.1 kg, 0.1 m: I = m a^2 / 6 */
    rlf_body_id id = add_body(world, &def);
    rlf_vec3 point = rlf_add(def.position, rlf_vec3_make(0, 0.05, 0));
    assert_true(rlf_world_apply_impulse(world, id, rlf_vec3_make(0.01, 0, 0), point));
    assert_true(fabs(body_at(world, 0)->velocity.x - 0.1) < 1e-12);
    double I = 0.1 * 0.01 / 6;
    assert_true(fabs(body_at(world, 0)->angular_velocity.z + 0.05 * 0.01 / I) < 1e-9);
}

/* Torque-free rotation about the middle axis, where a box tumbles. */
TEST_CASE(tumbling_box_keeps_energy_and_momentum)
{
    no_gravity();
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(0.2, 0.1, 0.04);
    def.mass = 1;
    def.angular_velocity = rlf_vec3_make(0.01, 10, 0.01);
    add_body(world, &def);
    rlf_mat3 I = rlf_shape_inertia(&def.shape, def.mass);
    rlf_vec3 L0 = rlf_mat3_mul_vec(&I, def.angular_velocity);
    double E0 = rlf_world_energy(world), worst_E = 0, worst_L = 0;
    int flips = 0;
    double sign = 1, first_flip = 0;
    for (int i = 1; i <= 24000; i++) {
        rlf_world_advance(world, NULL, 1.0 / 240);
        const rlf_body_state *b = body_at(world, 0);
        rlf_quat inverse = rlf_quat_conjugate(b->T_world_body.q);
        rlf_vec3 w = rlf_rotate(inverse, b->angular_velocity);
        rlf_vec3 L = rlf_rotate(b->T_world_body.q, rlf_mat3_mul_vec(&I, w));
        worst_E = rlf_max(worst_E, fabs(rlf_world_energy(world) / E0 - 1));
        worst_L = rlf_max(worst_L, rlf_length(rlf_sub(L, L0)) / rlf_length(L0));
        if (w.y * sign < 0) {
            first_flip = flips++ == 0 ? i / 240.0 : first_flip;
            sign = -sign;
        }
    }
    assert_true(worst_E <= 1e-6);
    assert_true(worst_L <= 1e-12);
    assert_int_equal(flips, 37); /* as with steps ten times finer */
    assert_true(fabs(first_flip - 1.592) <= 0.002);
}

TEST_CASE(held_until_release)
{
    rlf_body_def def = rlf_body_def_default();
    def.release_time = 0.5;
    def.velocity = rlf_vec3_make(1, 0, 0);
    add_body(world, &def);
    for (int i = 0; i < 10; i++) {
        rlf_world_advance(world, NULL, 0.05);
        if (i < 9) {
            assert_true(body_at(world, 0)->is_held);
            assert_true(body_at(world, 0)->T_world_body.p.x == def.position.x);
            assert_true(body_at(world, 0)->T_world_body.p.y == def.position.y);
        }
    }
    rlf_world_advance(world, NULL, 0.2);
    assert_false(body_at(world, 0)->is_held);
    assert_true(fabs(body_at(world, 0)->T_world_body.p.x - 0.2) < 1e-9);
    assert_true(fabs(body_at(world, 0)->T_world_body.p.y - 0.5 * 9.81 * 0.04) < 1e-9);
}

TEST_EACH(start_world, stop_world)
