/* Bodies that the caller moves, bodies that slow down by themselves, and who touches whom. */
#include "each_world.h"
#include "test.h"

#include <math.h>

#define FRAME (1.0 / 60)

static void advance(double seconds)
{
    advance_steps(world, NULL, (int)(seconds / FRAME + 0.5), FRAME);
}

/* v(t) = v0 exp(-c t), w(t) = w0 exp(-c t). */
TEST_CASE(damping_is_exponential)
{
    no_gravity();
    rlf_body_def def = rlf_body_def_default();
    def.velocity = rlf_vec3_make(2, 0, 0);
    def.angular_velocity = rlf_vec3_make(0, 3, 0);
    def.linear_damping = 0.7;
    def.angular_damping = 1.5;
    add_body(world, &def);
    advance(2);
    assert_true(fabs(body_at(world, 0)->velocity.x - 2 * exp(-1.4)) < 1e-9);
    assert_true(fabs(body_at(world, 0)->angular_velocity.y - 3 * exp(-3.0)) < 1e-9);
}

/* Falling with damping ends at g / c. */
TEST_CASE(damped_fall_has_a_last_speed)
{
    rlf_body_def def = rlf_body_def_default();
    def.linear_damping = 4;
    def.position = rlf_vec3_make(0, -5, 1);
    add_body(world, &def);
    advance(4);
    assert_true(fabs(body_at(world, 0)->velocity.y - 9.81 / 4) < 0.03);
}

static rlf_body_def plate(void)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(0.6, 0.1, 0.6);
    def.is_kinematic = true;
    return def;
}

/* Gravity does not move it, and a blow does not either; its velocities do, exactly. */
TEST_CASE(kinematic_body_obeys_only_the_caller)
{
    rlf_body_def def = plate();
    rlf_body_id id = add_body(world, &def);
    def = rlf_body_def_default();
    def.position = rlf_vec3_make(0, -0.5, 1);
    def.mass = 50;
    add_body(world, &def);
    rlf_pose pose = rlf_pose_identity();
    pose.p = rlf_vec3_make(0, 0, 1);
    assert_true(
        rlf_world_set_body(world, id, &pose, rlf_vec3_make(0.25, 0, 0), rlf_vec3_make(0, 0.5, 0)));
    assert_true(rlf_world_apply_impulse(world, id, rlf_vec3_make(9, 9, 9), pose.p));
    advance(1);
    rlf_pose T = body_at(world, 0)->T_world_body;
    assert_true(fabs(T.p.x - 0.25) < 1e-12 && T.p.y == 0.0 && T.p.z == 1.0);
    assert_true(fabs(2 * asin(T.q.y) - 0.5) < 1e-9);
}

/* A cube asleep on the plate is woken and lifted when the plate starts, and carried when it turns
 * to the side. */
TEST_CASE(kinematic_plate_lifts_and_carries)
{
    rlf_body_def def = plate();
    rlf_body_id id = add_body(world, &def);
    def = rlf_body_def_default();
    def.position = rlf_vec3_make(0.05, -0.1, 1);
    add_body(world, &def);
    advance(2);
    assert_true(body_at(world, 1)->is_asleep);
    rlf_pose pose = body_at(world, 0)->T_world_body;
    rlf_vec3 none = {0, 0, 0};
    assert_true(rlf_world_set_body(world, id, &pose, rlf_vec3_make(0, -0.5, 0), none));
    advance(1);
    assert_true(fabs(body_at(world, 1)->velocity.y + 0.5) < 0.01);
    assert_true(fabs(body_at(world, 1)->T_world_body.p.y + 0.6) < 0.003);
    pose = body_at(world, 0)->T_world_body;
    assert_true(rlf_world_set_body(world, id, &pose, rlf_vec3_make(0.4, 0, 0), none));
    advance(1);
    assert_true(fabs(body_at(world, 1)->velocity.x - 0.4) < 0.01);
    assert_true(fabs(body_at(world, 1)->T_world_body.p.y + 0.6) < 0.01);
}

/* Two kinematic bodies pass through each other: nothing moves either. */
TEST_CASE(kinematic_bodies_ignore_each_other)
{
    for (int k = 0; k < 2; k++) {
        rlf_body_def def = plate();
        def.position.x = k == 0 ? -1 : 1;
        def.velocity.x = k == 0 ? 1 : -1;
        add_body(world, &def);
    }
    advance(2);
    assert_true(fabs(body_at(world, 0)->T_world_body.p.x - 1) < 1e-9);
    assert_true(fabs(body_at(world, 1)->T_world_body.p.x + 1) < 1e-9);
}

typedef struct event_counts {
    int begun, ended;
} event_counts;

static event_counts count_events(rlf_body_id id)
{
    event_counts counts = {0, 0};
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    for (int32_t i = 0; i < s->event_count; i++) {
        const rlf_contact_event *e = &s->events[i];
        if (e->body.index1 == id.index1 || e->other_body.index1 == id.index1) {
            counts.begun += e->is_begin;
            counts.ended += !e->is_begin;
        }
    }
    return counts;
}

/* A cube is dropped on a still plate, falls asleep there and is thrown off: one begin, one end. */
TEST_CASE(touching_begins_and_ends_once)
{
    rlf_body_def def = plate();
    def.restitution = 0;
    rlf_body_id plate_id = add_body(world, &def);
    def = rlf_body_def_default();
    def.position = rlf_vec3_make(0, -0.11, 1);
    def.restitution = 0;
    rlf_body_id cube_id = add_body(world, &def);
    event_counts total = {0, 0};
    for (int k = 0; k < 150; k++) {
        rlf_world_advance(world, NULL, FRAME);
        event_counts counts = count_events(cube_id);
        total.begun += counts.begun;
        total.ended += counts.ended;
    }
    assert_true(body_at(world, 1)->is_asleep);
    assert_int_equal(total.begun, 1);
    assert_int_equal(total.ended, 0);
    assert_true(rlf_world_apply_impulse(world, cube_id, rlf_vec3_make(0, -0.3, 0),
                                        body_at(world, 1)->T_world_body.p));
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    int ended = 0;
    for (int k = 0; k < 5 && ended == 0; k++) {
        advance(FRAME);
        ended = count_events(cube_id).ended;
    }
    assert_int_equal(ended, 1);
    assert_int_equal(s->events[0].body.index1, plate_id.index1);
    assert_int_equal(s->events[0].other, RLF_CONTACT_BODY);
    assert_int_equal(s->events[0].other_body.index1, cube_id.index1);
    advance(FRAME);
    assert_int_equal(rlf_world_get_snapshot(world)->event_count, 0);
}

/* What goes ends its touches, under its own generation. */
TEST_CASE(removal_ends_touching)
{
    rlf_body_def def = plate();
    add_body(world, &def);
    def = rlf_body_def_default();
    def.position = rlf_vec3_make(0, -0.1, 1);
    rlf_body_id id = add_body(world, &def);
    advance(2);
    rlf_world_remove_body(world, id);
    advance(FRAME);
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    assert_int_equal(s->event_count, 1);
    assert_false(s->events[0].is_begin);
    assert_int_equal(s->events[0].other_body.generation, id.generation);
}

TEST_CASE(the_thesis_method_has_no_kinematic_bodies)
{
    rlf_world_def thesis_def = small_world_def();
    thesis_def.method = RLF_PHYSICS_THESIS;
    rlf_world *thesis = world_of(&thesis_def);
    rlf_body_def def = plate();
    assert_int_equal(rlf_world_add_body(thesis, &def, NULL), RLF_ERROR_INVALID);
    rlf_world_destroy(&thesis);
}

TEST_EACH(start_world, stop_world)
