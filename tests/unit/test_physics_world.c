/* The world's manners: defs, handles, capacity, bounds, determinism, no allocation. */
#include "relief/world.h"
#include "test.h"

#include "count_assert.h"
#include "grid_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int assert_count;

static rlf_world *make_world(rlf_physics_method method, int32_t bodies, rlf_pool *pool)
{
    rlf_world_def def = rlf_world_def_default();
    def.method = method;
    def.body_capacity = bodies;
    def.contact_capacity = 2048;
    def.pool = pool;
    rlf_world *world = NULL;
    assert_int_equal(rlf_world_create(&def, &world), RLF_OK);
    return world;
}

static void expect_refused(rlf_world *world, const rlf_body_def *def, const char *field)
{
    rlf_body_id id = {77, 77};
    assert_int_equal(rlf_world_add_body(world, def, &id), RLF_ERROR_INVALID);
    assert_int_equal(id.index1, 77);
    assert_non_null(strstr(rlf_error_text(), field));
}

static void bad_bodies_are_named(void **state)
{
    (void)state;
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 4, NULL);
    const double bad[] = {NAN, INFINITY, -1, 0};
    for (int i = 0; i < 4; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.mass = bad[i];
        expect_refused(world, &def, "mass");
        def = rlf_body_def_default();
        def.shape.size.y = bad[i];
        expect_refused(world, &def, "shape.size");
        def = rlf_body_def_default();
        def.shape.type = RLF_SHAPE_CYLINDER;
        def.shape.radius = 0.1;
        def.shape.height = bad[i];
        expect_refused(world, &def, "shape.height");
        def.shape.radius = bad[i];
        expect_refused(world, &def, "shape.radius");
    }
    rlf_body_def def = rlf_body_def_default();
    def.position.x = NAN;
    expect_refused(world, &def, "position");
    def = rlf_body_def_default();
    def.velocity.z = INFINITY;
    expect_refused(world, &def, "velocity");
    def = rlf_body_def_default();
    def.angular_velocity.z = NAN;
    expect_refused(world, &def, "angular_velocity");
    def = rlf_body_def_default();
    def.orientation = (rlf_quat){0, 0, 0, 0};
    expect_refused(world, &def, "orientation");
    def = rlf_body_def_default();
    def.restitution = 1.5;
    expect_refused(world, &def, "restitution");
    def = rlf_body_def_default();
    def.friction = -0.1;
    expect_refused(world, &def, "friction");
    def = rlf_body_def_default();
    def.shape.size.x = 101;
    expect_refused(world, &def, "shape.size");
    def = rlf_body_def_default();
    def.shape.type = RLF_SHAPE_HULL;
    expect_refused(world, &def, "shape.hull");
    const rlf_vec3 line[4] = {{-1, 0, 0}, {-0.3, 0, 0}, {0.3, 0, 0}, {1, 0, 0}};
    const int32_t triangles[12] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    rlf_hull hull = {line, 4, triangles, 4};
    def.shape.hull = &hull;
    expect_refused(world, &def, "hull");
    def = rlf_body_def_default();
    memset(def.name, 'x', sizeof(def.name));
    expect_refused(world, &def, "name");
    assert_int_equal(rlf_world_get_snapshot(world)->body_count, 0);
    rlf_world_destroy(&world);
    assert_null(world);
}

static void bad_worlds_are_named(void **state)
{
    (void)state;
    rlf_world *world = NULL;
    rlf_world_def def = rlf_world_def_default();
    def.gravity.y = NAN;
    assert_int_equal(rlf_world_create(&def, &world), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "gravity"));
    def = rlf_world_def_default();
    def.body_capacity = 0;
    assert_int_equal(rlf_world_create(&def, &world), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "body_capacity"));
    def = rlf_world_def_default();
    def.step_hz = 0;
    assert_int_equal(rlf_world_create(&def, &world), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "step_hz"));
    assert_null(world);
    rlf_set_assert(count_assert, &assert_count);
    rlf_world_def zero;
    memset(&zero, 0, sizeof(zero));
    assert_count = 0;
    assert_int_equal(rlf_world_create(&zero, &world), RLF_ERROR_INVALID);
    rlf_world_advance(NULL, NULL, 0.1);
    assert_int_equal(assert_count, 2);
    rlf_set_assert(NULL, NULL);
}

static void handles_go_stale(void **state)
{
    (void)state;
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_body_def def = rlf_body_def_default();
    rlf_body_id a, b, c, none = {0, 0};
    assert_int_equal(rlf_world_add_body(world, &def, &a), RLF_OK);
    def.position.x = 1;
    assert_int_equal(rlf_world_add_body(world, &def, &b), RLF_OK);
    assert_int_equal(rlf_world_add_body(world, &def, &c), RLF_ERROR_CAPACITY);
    assert_string_equal(rlf_world_get_snapshot(world)->bodies[1].name, "body-2");
    assert_false(rlf_world_has_body(world, none));
    rlf_world_remove_body(world, a);
    rlf_world_remove_body(world, a);
    assert_false(rlf_world_has_body(world, a));
    assert_true(rlf_world_has_body(world, b));
    assert_int_equal(rlf_world_add_body(world, &def, &c), RLF_OK);
    assert_int_equal(c.index1, a.index1);
    assert_true(c.generation != a.generation);
    rlf_pose pose = rlf_pose_identity();
    rlf_vec3 zero = {0, 0, 0}, wrong = {NAN, 0, 0};
    assert_false(rlf_world_set_body(world, a, &pose, zero, zero));
    assert_false(rlf_world_apply_impulse(world, a, zero, zero));
    assert_false(rlf_world_apply_force(world, none, zero, zero));
    assert_false(rlf_world_set_body(world, c, &pose, wrong, zero));
    assert_true(rlf_world_set_body(world, c, &pose, zero, zero));
    assert_true(rlf_world_get_snapshot(world)->bodies[0].T_world_body.p.z == 0.0);
    rlf_world_reset(world);
    assert_false(rlf_world_has_body(world, c));
    assert_int_equal(rlf_world_get_snapshot(world)->body_count, 0);
    assert_int_equal(rlf_world_get_snapshot(world)->time_ns, 0);
    rlf_world_destroy(&world);
}

/* A body that was taken away comes back, and then does what it would have done. */
static void a_body_comes_back_as_it_was(void **state)
{
    (void)state;
    rlf_world *one = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_world *other = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_body_def def = rlf_body_def_default(), again;
    rlf_body_id id;
    snprintf(def.name, sizeof def.name, "crate");
    def.velocity = rlf_vec3_make(0.5, -1, 0.2);
    def.angular_velocity = rlf_vec3_make(1, 2, 3);
    def.restitution = 0.8;
    def.friction = 0.1;
    def.gravity_scale = 0.5;
    def.linear_damping = 0.3;
    def.angular_damping = 0.2;
    def.rolling_resistance = 0.01;
    assert_int_equal(rlf_world_add_body(one, &def, &id), RLF_OK);
    assert_true(rlf_world_get_body_def(one, id, &again));
    again.orientation = def.orientation; /* normalised there */
    assert_memory_equal(&again, &def, sizeof def);
    for (int i = 0; i < 5; i++) {
        rlf_world_advance(one, NULL, 1.0 / 30);
    }
    assert_true(rlf_world_get_body_def(one, id, &again));
    assert_int_equal(rlf_world_add_body(other, &again, NULL), RLF_OK);
    for (int i = 0; i < 5; i++) {
        rlf_world_advance(one, NULL, 1.0 / 30);
        rlf_world_advance(other, NULL, 1.0 / 30);
    }
    const rlf_body_state *a = rlf_world_get_snapshot(one)->bodies;
    const rlf_body_state *b = rlf_world_get_snapshot(other)->bodies;
    assert_string_equal(b->name, "crate");
    assert_true(rlf_length(rlf_sub(a->T_world_body.p, b->T_world_body.p)) < 1e-9);
    assert_true(rlf_length(rlf_sub(a->angular_velocity, b->angular_velocity)) < 1e-6);
    rlf_world_remove_body(one, id);
    assert_false(rlf_world_get_body_def(one, id, &again));
    rlf_world_destroy(&one);
    rlf_world_destroy(&other);
}

/* An index beyond any that there can be names nothing. */
static void no_handle_is_out_of_range(void **state)
{
    (void)state;
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_body_def def = rlf_body_def_default();
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    const uint32_t wrong[] = {0, 3, 0x7fffffffu, 0x80000000u, 0xffffffffu};
    for (int i = 0; i < 5; i++) {
        rlf_body_id id = {wrong[i], 1};
        assert_false(rlf_world_has_body(world, id));
    }
    rlf_world_destroy(&world);
}

static void leaves_at_the_bounds(void **state)
{
    (void)state;
    for (int method = 0; method < 2; method++) {
        rlf_world *world = make_world((rlf_physics_method)method, 2, NULL);
        rlf_body_def def = rlf_body_def_default();
        rlf_body_id id;
        def.velocity = rlf_vec3_make(30, 0, 0);
        assert_int_equal(rlf_world_add_body(world, &def, &id), RLF_OK);
        for (int k = 0; k < 30; k++) {
            rlf_world_advance(world, NULL, 1.0 / 30);
        }
        assert_false(rlf_world_has_body(world, id));
        assert_int_equal(rlf_world_get_snapshot(world)->body_count, 0);
        rlf_world_destroy(&world);
    }
}

static void odd_time_steps_are_told_and_do_nothing(void **state)
{
    (void)state;
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_body_def def = rlf_body_def_default();
    assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    uint64_t hash = rlf_world_hash(world);
    const double steps[] = {0, -1, 10, NAN, INFINITY};
    rlf_set_assert(count_assert, &assert_count);
    assert_count = 0;
    for (int i = 0; i < 5; i++) {
        rlf_world_advance(world, NULL, steps[i]);
        assert_int_equal(assert_count, i + 1);
    }
    rlf_set_assert(NULL, NULL);
    assert_true(rlf_world_hash(world) == hash);
    assert_int_equal(rlf_world_get_snapshot(world)->time_ns, 0);
    rlf_world_destroy(&world);
}

/* Bodies of all shapes fall on the room; returns the hash of the run. The thesis's narrow phase
 * asks all points of the room for each body, so it gets fewer. */
static uint64_t crowd(grid_fixture *f, rlf_physics_method method, rlf_pool *pool, uint64_t *allocs)
{
    rlf_world *world = make_world(method, 64, pool);
    int bodies = method == RLF_PHYSICS_LIVE ? 40 : 8;
    for (int i = 0; i < bodies; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape.type = (rlf_shape_type)(i % 4);
        def.shape.radius = 0.04;
        def.shape.height = 0.08;
        def.position =
            rlf_vec3_make(0.11 * (i % 5) - 0.2, 0.7 - 0.12 * (i / 5), 2 + 0.03 * (i % 7));
        def.velocity = rlf_vec3_make(0.3, 0, 0.1 * (i % 3));
        assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    }
    uint64_t hash = 0;
    uint64_t before = rlf_alloc_count();
    for (int k = 0; k < (method == RLF_PHYSICS_LIVE ? 45 : 20); k++) {
        f->grid.time_ns = k;
        rlf_world_advance(world, &f->grid, 1.0 / 30);
        hash = hash * 31 + rlf_world_hash(world);
    }
    *allocs = rlf_alloc_count() - before;
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    for (int i = 0; i < s->body_count; i++) {
        assert_true(rlf_vec3_is_finite(s->bodies[i].T_world_body.p));
        assert_true(rlf_length(s->bodies[i].velocity) <= 50);
    }
    assert_int_equal(s->body_count, bodies);
    rlf_world_destroy(&world);
    return hash;
}

static void same_bits_for_any_pool_and_no_allocation(void **state)
{
    (void)state;
    grid_fixture *f = grid_fixture_create();
    grid_plane room[2] = {grid_floor(1), grid_wall(4)};
    grid_fixture_set_room(f, room, 2);
    for (int method = 0; method < 2; method++) {
        uint64_t allocs, hash = crowd(f, (rlf_physics_method)method, NULL, &allocs);
        assert_int_equal(allocs, 0);
        for (int32_t workers = 1; workers <= 3; workers++) {
            rlf_pool *pool = NULL;
            assert_int_equal(rlf_pool_create(workers, &pool), RLF_OK);
            assert_true(crowd(f, (rlf_physics_method)method, pool, &allocs) == hash);
            assert_int_equal(allocs, 0);
            rlf_pool_destroy(&pool);
        }
    }
    grid_fixture_destroy(&f);
}

/* Everybody in one place: pushed apart without an explosion. */
static void heap_in_one_place(void **state)
{
    (void)state;
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 300, NULL);
    rlf_body_def def = rlf_body_def_default();
    for (int i = 0; i < 300; i++) {
        assert_int_equal(rlf_world_add_body(world, &def, NULL), RLF_OK);
    }
    for (int k = 0; k < 5; k++) {
        rlf_world_advance(world, NULL, 1.0 / 60);
        const rlf_snapshot *s = rlf_world_get_snapshot(world);
        for (int i = 0; i < s->body_count; i++) {
            assert_true(rlf_vec3_is_finite(s->bodies[i].T_world_body.p));
            assert_true(rlf_length(s->bodies[i].velocity) < 20);
        }
    }
    rlf_world_destroy(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_bodies_are_named),
        cmocka_unit_test(bad_worlds_are_named),
        cmocka_unit_test(handles_go_stale),
        cmocka_unit_test(a_body_comes_back_as_it_was),
        cmocka_unit_test(no_handle_is_out_of_range),
        cmocka_unit_test(leaves_at_the_bounds),
        cmocka_unit_test(odd_time_steps_are_told_and_do_nothing),
        cmocka_unit_test(same_bits_for_any_pool_and_no_allocation),
        cmocka_unit_test(heap_in_one_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
