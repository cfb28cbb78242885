/* The world's manners: defs, handles, capacity, bounds, determinism, no allocation. */
#include "small_world.h"
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
    return world_of(&def);
}

static void expect_refused(rlf_world *world, const rlf_body_def *def, const char *field)
{
    rlf_body_id id = {77, 77};
    assert_int_equal(rlf_world_add_body(world, def, &id), RLF_ERROR_INVALID);
    assert_int_equal(id.index1, 77);
    assert_non_null(strstr(rlf_error_text(), field));
}

/* What is finite and yet no body; unit.def_fields tries what is not finite. */
#define AT(member) offsetof(rlf_body_def, member)
static const struct {
    rlf_shape_type type;
    size_t at;
    double value;
    const char *field;
} BAD[] = {{RLF_SHAPE_BOX, AT(mass), -1, "mass"},
           {RLF_SHAPE_BOX, AT(mass), 0, "mass"},
           {RLF_SHAPE_BOX, AT(shape.size.y), -1, "shape.size"},
           {RLF_SHAPE_BOX, AT(shape.size.y), 0, "shape.size"},
           {RLF_SHAPE_BOX, AT(shape.size.x), 101, "shape.size"},
           {RLF_SHAPE_CYLINDER, AT(shape.height), NAN, "shape.height"},
           {RLF_SHAPE_CYLINDER, AT(shape.height), -1, "shape.height"},
           {RLF_SHAPE_CYLINDER, AT(shape.height), 0, "shape.height"},
           {RLF_SHAPE_CYLINDER, AT(shape.radius), INFINITY, "shape.radius"},
           {RLF_SHAPE_CYLINDER, AT(shape.radius), -1, "shape.radius"},
           {RLF_SHAPE_CYLINDER, AT(shape.radius), 0, "shape.radius"},
           {RLF_SHAPE_BOX, AT(restitution), 1.5, "restitution"},
           {RLF_SHAPE_BOX, AT(friction), -0.1, "friction"},
           {RLF_SHAPE_BOX, AT(linear_damping), -1, "linear_damping"},
           {RLF_SHAPE_HULL, AT(mass), 1, "shape.hull"}};

TEST_CASE(bad_bodies_are_named)
{
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 4, NULL);
    rlf_body_def def;
    for (size_t i = 0; i < sizeof(BAD) / sizeof(BAD[0]); i++) {
        def = rlf_body_def_default();
        def.shape.type = BAD[i].type;
        def.shape.radius = def.shape.height = 0.1;
        memcpy((char *)&def + BAD[i].at, &BAD[i].value, sizeof(double));
        expect_refused(world, &def, BAD[i].field);
    }
    def = rlf_body_def_default();
    def.orientation = (rlf_quat){0, 0, 0, 0};
    expect_refused(world, &def, "orientation");
    const rlf_vec3 line[4] = {{-1, 0, 0}, {-0.3, 0, 0}, {0.3, 0, 0}, {1, 0, 0}};
    const int32_t triangles[12] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    const rlf_hull flat = {line, 4, triangles, 4};
    def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_HULL, .hull = &flat};
    expect_refused(world, &def, "hull");
    def = rlf_body_def_default();
    memset(def.name, 'x', sizeof(def.name));
    expect_refused(world, &def, "name");
    assert_int_equal(rlf_world_get_snapshot(world)->body_count, 0);
    rlf_world_destroy(&world);
    assert_null(world);
}

TEST_CASE(bad_worlds_are_named)
{
    rlf_world *world = NULL;
    rlf_world_def def = rlf_world_def_default();
    def.body_capacity = 0;
    assert_int_equal(rlf_world_create(&def, &world), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "body_capacity"));
    def = rlf_world_def_default();
    def.step_hz = 0;
    assert_int_equal(rlf_world_create(&def, &world), RLF_ERROR_INVALID);
    assert_non_null(strstr(rlf_error_text(), "step_hz"));
    assert_null(world);
    const rlf_world_def zero = {0};
    rlf_set_assert(count_assert, &assert_count);
    assert_count = 0;
    assert_int_equal(rlf_world_create(&zero, &world), RLF_ERROR_INVALID);
    rlf_world_advance(NULL, NULL, 0.1);
    assert_int_equal(assert_count, 2);
    rlf_set_assert(NULL, NULL);
}

TEST_CASE(handles_go_stale)
{
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_body_def def = rlf_body_def_default();
    rlf_body_id a, b, c, none = {0, 0};
    a = add_body(world, &def);
    def.position.x = 1;
    b = add_body(world, &def);
    assert_int_equal(rlf_world_add_body(world, &def, &c), RLF_ERROR_CAPACITY);
    assert_string_equal(rlf_world_get_snapshot(world)->bodies[1].name, "body-2");
    assert_false(rlf_world_has_body(world, none));
    rlf_world_remove_body(world, a);
    rlf_world_remove_body(world, a);
    assert_false(rlf_world_has_body(world, a));
    assert_true(rlf_world_has_body(world, b));
    c = add_body(world, &def);
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
TEST_CASE(a_body_comes_back_as_it_was)
{
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
    id = add_body(one, &def);
    assert_true(rlf_world_get_body_def(one, id, &again));
    again.orientation = def.orientation; /* normalised there */
    assert_memory_equal(&again, &def, sizeof def);
    advance_steps(one, NULL, 5, 1.0 / 30);
    assert_true(rlf_world_get_body_def(one, id, &again));
    add_body(other, &again);
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
TEST_CASE(no_handle_is_out_of_range)
{
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_body_def def = rlf_body_def_default();
    add_body(world, &def);
    const uint32_t wrong[] = {0, 3, 0x7fffffffu, 0x80000000u, 0xffffffffu};
    for (int i = 0; i < 5; i++) {
        rlf_body_id id = {wrong[i], 1};
        assert_false(rlf_world_has_body(world, id));
    }
    rlf_world_destroy(&world);
}

TEST_CASE(leaves_at_the_bounds)
{
    for (int method = 0; method < 2; method++) {
        rlf_world *world = make_world((rlf_physics_method)method, 2, NULL);
        rlf_body_def def = rlf_body_def_default();
        rlf_body_id id;
        def.velocity = rlf_vec3_make(30, 0, 0);
        id = add_body(world, &def);
        advance_steps(world, NULL, 30, 1.0 / 30);
        assert_false(rlf_world_has_body(world, id));
        assert_int_equal(rlf_world_get_snapshot(world)->body_count, 0);
        rlf_world_destroy(&world);
    }
}

TEST_CASE(odd_time_steps_are_told_and_do_nothing)
{
    rlf_world *world = make_world(RLF_PHYSICS_LIVE, 2, NULL);
    rlf_body_def def = rlf_body_def_default();
    add_body(world, &def);
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
        add_body(world, &def);
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

TEST_CASE(same_bits_for_any_pool_and_no_allocation)
{
    grid_fixture *f = grid_fixture_create();
    grid_plane room[2] = {grid_floor(1), grid_wall(4)};
    grid_fixture_set_room(f, room, 2);
    for (int method = 0; method < 2; method++) {
        uint64_t allocs, hash = crowd(f, (rlf_physics_method)method, NULL, &allocs);
        assert_int_equal(allocs, 0);
        for (int32_t workers = 1; workers <= 3; workers++) {
            rlf_pool *pool = pool_of(workers);
            assert_true(crowd(f, (rlf_physics_method)method, pool, &allocs) == hash);
            assert_int_equal(allocs, 0);
            rlf_pool_destroy(&pool);
        }
    }
    grid_fixture_destroy(&f);
}
