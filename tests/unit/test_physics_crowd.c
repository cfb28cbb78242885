/* Many bodies, long stacks, lost frames and bad input: nothing explodes, nothing is allocated, and
 * the workers do not matter. */
#include "physics/grid/cast.h"
#include "small_world.h"
#include "test.h"
#include "grid_shared.h"
#include "heavy.h"

#include <math.h>

#define FRAME (1.0 / 30)

static void set_floor(double height)
{
    grid_plane room[2] = {grid_floor(height), grid_wall(5)};
    grid_fixture_set_room(fixture, room, 2);
    memset(fixture->mask, 0, (size_t)GRID_W * GRID_H);
    fixture->grid.time_ns++;
}

static rlf_world *make_world(int32_t bodies, rlf_pool *pool)
{
    rlf_world_def def = rlf_world_def_default();
    def.body_capacity = bodies;
    def.border = RLF_BORDER_EXTEND;
    def.pool = pool;
    return world_of(&def);
}

/* Layers of bodies of four shapes over the floor. */
static void add_crowd(rlf_world *world, int count)
{
    for (int i = 0; i < count; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.shape.type = (rlf_shape_type)(i % 4);
        def.shape.radius = 0.04;
        def.shape.height = 0.08;
        def.position = rlf_vec3_make(0.16 * (i % 12) - 0.9, 0.8 - 0.16 * (i / 120),
                                     2.0 + 0.16 * (i / 12 % 10));
        def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0.1 * i, 0.2 * i, 0.3 * i));
        add_body(world, &def);
    }
}

static double fastest(const rlf_world *world)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    double most = 0;
    for (int i = 0; i < s->body_count; i++) {
        assert_true(rlf_vec3_is_finite(s->bodies[i].T_world_body.p));
        assert_true(rlf_vec3_is_finite(s->bodies[i].velocity));
        assert_true(rlf_vec3_is_finite(s->bodies[i].angular_velocity));
        most = rlf_max(most, rlf_length(s->bodies[i].velocity));
    }
    return most;
}

TEST_CASE(thousand_bodies_allocate_nothing)
{
    set_floor(1);
    const int count = heavy(1000, 60);
    rlf_world *world = make_world(count, NULL);
    add_crowd(world, count);
    uint64_t before = rlf_alloc_count();
    for (int k = 0; k < 20; k++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, FRAME);
        assert_true(fastest(world) < 20);
    }
    assert_int_equal(rlf_alloc_count() - before, 0);
    rlf_world_destroy(&world);
}

static uint64_t hash_of_run(rlf_pool *pool)
{
    const int count = heavy(300, 40);
    rlf_world *world = make_world(count, pool);
    add_crowd(world, count);
    uint64_t hash = 0;
    for (int k = 0; k < heavy(40, 6); k++) {
        fixture->grid.time_ns = k + 1;
        rlf_world_advance(world, &fixture->grid, FRAME);
        hash = hash * 31 + rlf_world_hash(world);
    }
    rlf_world_destroy(&world);
    return hash;
}

TEST_CASE(workers_do_not_matter)
{
    set_floor(1);
    uint64_t hash = hash_of_run(NULL);
    for (int32_t workers = 2; workers <= heavy(4, 2); workers++) {
        rlf_pool *pool = pool_of(workers);
        assert_true(hash_of_run(pool) == hash);
        rlf_pool_destroy(&pool);
    }
}

TEST_CASE(thousands_in_one_place)
{
    const int count = heavy(5000, 200);
    rlf_world *world = make_world(count, NULL);
    rlf_body_def def = rlf_body_def_default();
    for (int i = 0; i < count; i++) {
        add_body(world, &def);
    }
    for (int k = 0; k < 2; k++) {
        rlf_world_advance(world, NULL, 1.0 / 60);
        assert_true(fastest(world) < 20);
    }
    rlf_world_destroy(&world);
}

static double moving_energy(const rlf_world *world)
{
    const rlf_snapshot *s = rlf_world_get_snapshot(world);
    double sum = 0;
    for (int i = 0; i < s->body_count; i++) {
        sum += 0.5 * s->bodies[i].mass * rlf_dot(s->bodies[i].velocity, s->bodies[i].velocity);
    }
    return sum;
}

/* 300 cubes overlap wholly. What pushes them apart is taken out of their speed again, in more
 * passes than else: two leave 24 m/s and 700 J. */
TEST_CASE(heap_in_one_place_comes_apart_at_bounded_speed)
{
    heavy_needs_whole(); /* thousands_in_one_place runs the same code */
    rlf_world *world = make_world(300, NULL);
    assert_true(rlf_world_set_gravity(world, rlf_vec3_make(0, 0, 0)));
    rlf_body_def def = rlf_body_def_default();
    for (int i = 0; i < 300; i++) {
        add_body(world, &def);
    }
    double most = 0, energy = 0;
    for (int k = 0; k < 60; k++) {
        rlf_world_advance(world, NULL, 1.0 / 60);
        most = rlf_max(most, fastest(world));
        energy = rlf_max(energy, moving_energy(world));
    }
    assert_true(most < 5 && energy < 20);
    rlf_world_destroy(&world);
}

/* Ten cubes on one another, the lowest added last: the order of bodies does not matter. */
TEST_CASE(stack_added_from_above)
{
    set_floor(1);
    rlf_world *world = make_world(10, NULL);
    rlf_body_def def = rlf_body_def_default();
    for (int i = 0; i < 10; i++) {
        def.position = rlf_vec3_make(0.2, 0.95 - 0.1 * (9 - i), 2.5);
        add_body(world, &def);
    }
    advance_frames(world, &fixture->grid, 300, FRAME);
    double drift = 0;
    for (int i = 0; i < 10; i++) {
        rlf_vec3 p = rlf_world_get_snapshot(world)->bodies[i].T_world_body.p;
        drift = rlf_max(drift, hypot(p.x - 0.2, p.z - 2.5));
        drift = rlf_max(drift, fabs(p.y - (0.95 - 0.1 * (9 - i))) / 10);
    }
    assert_true(drift < 0.5e-3 && fastest(world) < 1e-4);
    rlf_world_destroy(&world);
}

/* The floor comes up or goes down by a metre from one frame to the next. */
TEST_CASE(surface_jumps_a_metre)
{
    set_floor(1);
    rlf_world *world = make_world(20, NULL);
    add_crowd(world, 20);
    for (int k = 0; k < 90; k++) {
        set_floor(k / 15 % 2 == 0 ? 1.0 : 0.01);
        rlf_world_advance(world, &fixture->grid, FRAME);
        assert_true(fastest(world) < 15);
    }
    rlf_world_destroy(&world);
}

/* NaN and infinities in any plane of the surface. */
TEST_CASE(bad_numbers_in_the_surface)
{
    const float bad[3] = {NAN, INFINITY, -INFINITY};
    for (int plane = 2; plane < 14; plane++) {
        set_floor(1);
        grid_fixture_set_slab(fixture, grid_floor(0.9), rlf_vec3_make(0, 0.9, 2.5),
                              rlf_vec3_make(0.4, 0, 0.4), 0.05, rlf_vec3_make(0, 0, 0));
        for (int i = 0; i < GRID_W * GRID_H; i += 3) {
            fixture->planes[plane][i] = bad[i / 3 % 3];
        }
        rlf_world *world = make_world(20, NULL);
        add_crowd(world, 20);
        for (int k = 0; k < 10; k++) {
            fixture->grid.time_ns++;
            rlf_world_advance(world, &fixture->grid, FRAME);
            assert_true(fastest(world) < 20);
        }
        rlf_world_destroy(&world);
    }
}

/* An endless way along an axis that it does not go would be no number. */
TEST_CASE(bad_thickness_is_as_thin_as_can_be)
{
    const float bad[5] = {NAN, INFINITY, -INFINITY, 1e30f, -1.0f};
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0, 0, 2), rlf_vec3_make(0.4, 0.4, 0),
                          0.05, rlf_vec3_make(0, 0, 0));
    const field_side nowhere = {.state = FIELD_NONE};
    for (int k = 0; k < 5; k++) {
        for (int i = 0; i < GRID_W * GRID_H; i++) {
            fixture->planes[13][i] = bad[k];
        }
        field_hit hit;
        rlf_vec3 from = {0.01, 0.02, 2.1}, path = {0, 0, -0.2};
        assert_true(
            grid_cast(&fixture->grid, &fixture->grid.foreground, from, path, 0.0, &nowhere, &hit));
        assert_true(rlf_vec3_is_finite(hit.point) && rlf_vec3_is_finite(hit.normal));
        assert_true(fabs(hit.point.z - 2.01) < 1e-6 && hit.normal.z > 0.999);
    }
}

/* A hand rises at 0.5 m/s and only every n-th frame arrives; its speed is what two of them show.
 * The cube stays on it. */
TEST_CASE(hand_lifts_through_lost_frames)
{
    for (int n = 2; n <= 11; n++) {
        set_floor(1.2);
        rlf_world *world = make_world(1, NULL);
        rlf_body_def def = rlf_body_def_default();
        def.restitution = 0.2;
        def.position = rlf_vec3_make(0.01, 0.75, 2.01);
        add_body(world, &def);
        double y = 0.8, seen = y;
        for (int k = 0; k < 44; k++) {
            y -= k >= 15 && k < 33 ? 0.5 * FRAME : 0.0;
            if (k % n == 0) {
                rlf_vec3 velocity = {0, k > 0 ? (y - seen) / (n * FRAME) : 0.0, 0};
                grid_fixture_set_slab(fixture, grid_floor(y), rlf_vec3_make(0, y, 2),
                                      rlf_vec3_make(0.2, 0, 0.2), 0.05, velocity);
                seen = y;
                fixture->grid.time_ns++;
            }
            rlf_world_advance(world, &fixture->grid, FRAME);
            assert_less(fastest(world), 5);
        }
        rlf_vec3 p = rlf_world_get_snapshot(world)->bodies[0].T_world_body.p;
        assert_true(n > 2 || p.y < y);
        rlf_world_destroy(&world);
    }
}

/* A ball that rolls without slipping slows down by 5/7 c g. */
TEST_CASE(rolling_resistance_slows_a_ball)
{
    const double c = 0.1, r = 0.1;
    set_floor(1);
    for (int k = 0; k < 2; k++) {
        rlf_world *world = make_world(1, NULL);
        rlf_body_def def = rlf_body_def_default();
        def.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = r};
        def.restitution = 0;
        def.rolling_resistance = k == 0 ? c : 0.0;
        def.position = rlf_vec3_make(-0.6, 1 - r, 2.5);
        def.velocity = rlf_vec3_make(1, 0, 0);
        def.angular_velocity = rlf_vec3_make(0, 0, 1 / r);
        add_body(world, &def);
        advance_frames(world, &fixture->grid, 24, FRAME);
        double v = rlf_world_get_snapshot(world)->bodies[0].velocity.x;
        double expected = k == 0 ? 1 - 5.0 / 7 * c * 9.81 * 0.8 : 1.0;
        assert_less(fabs(v - expected), 0.01);
        advance_frames(world, &fixture->grid, 30, FRAME);
        double later = rlf_world_get_snapshot(world)->bodies[0].velocity.x;
        assert_true(k == 0 ? fabs(later) < 1e-3 : later > 0.98);
        rlf_world_destroy(&world);
    }
}

TEST_GROUP(set_up, tear_down)
