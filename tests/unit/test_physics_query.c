/* Ray casts and overlaps: every reason, against bodies and both sheets. */
#include "count_assert.h"
#include "relief/query.h"
#include "small_world.h"
#include "test.h"
#include "grid_fixture.h"

#include <math.h>

static grid_fixture *fixture;
static rlf_world *world;
static rlf_body_id ids[3]; /* cube, ball, cylinder */

/* Floor 1 m down, wall at 4 m, a slab of foreground at 2..2.2 m, three bodies. */
static int set_up(void **state)
{
    (void)state;
    fixture = grid_fixture_create();
    grid_plane room[2] = {grid_floor(1.0), grid_wall(4)};
    grid_fixture_set_room(fixture, room, 2);
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0.5, 0, 2),
                          rlf_vec3_make(0.2, 0.2, 0), 0.2, rlf_vec3_make(0, 0, 0));
    fixture->grid.background.default_thickness = 0.15;
    for (int32_t i = 0; i < GRID_W * GRID_H; i++) { /* a hole far from everything */
        if (i % GRID_W < 40 && i / GRID_W < 40) {
            fixture->planes[2][i] = 0.0f;
        }
    }
    rlf_world_def world_def = small_world_def();
    if (rlf_world_create(&world_def, &world) != RLF_OK) {
        return 1;
    }
    rlf_body_def def = rlf_body_def_default();
    def.shape.radius = 0.05;
    def.shape.height = 0.2;
    const rlf_shape_type types[3] = {RLF_SHAPE_BOX, RLF_SHAPE_SPHERE, RLF_SHAPE_CYLINDER};
    for (int k = 0; k < 3; k++) {
        def.shape.type = types[k];
        def.position = rlf_vec3_make(-0.3 * k, 0, 1.5);
        if (rlf_world_add_body(world, &def, &ids[k]) != RLF_OK) {
            return 1;
        }
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    rlf_world_destroy(&world);
    grid_fixture_destroy(&fixture);
    return 0;
}

static rlf_ray_hit cast(rlf_vec3 origin, rlf_vec3 direction, double length)
{
    return rlf_world_cast_ray(world, &fixture->grid, origin, direction, length);
}

TEST_CASE(rays_hit_bodies)
{
    for (uint32_t k = 0; k < 3; k++) {
        rlf_vec3 from = rlf_vec3_make(-0.3 * k, 0.01, 0);
        rlf_ray_hit hit = cast(from, rlf_vec3_make(0, 0, 3), 5);
        assert_int_equal(hit.reason, RLF_QUERY_HIT);
        assert_int_equal(hit.other, RLF_CONTACT_BODY);
        assert_int_equal(hit.body.index1, ids[k].index1);
        double expected = k == 1 ? 1.5 - sqrt(0.05 * 0.05 - 0.01 * 0.01) : 1.45;
        assert_true(fabs(hit.distance - expected) < 1e-5);
        assert_true(hit.normal.z < -0.97 && fabs(hit.point.z - expected) < 1e-5);
        /* too short, and past it */
        assert_int_equal(cast(from, rlf_vec3_make(0, 0, 1), 1.4).reason, RLF_QUERY_MISS);
        from.y = 0.3;
        assert_int_equal(cast(from, rlf_vec3_make(0, 0, 1), 3).reason, RLF_QUERY_MISS);
    }
    rlf_ray_hit inside = cast(rlf_vec3_make(0, 0, 1.5), rlf_vec3_make(1, 0, 0), 1);
    assert_true(inside.reason == RLF_QUERY_HIT && inside.distance == 0.0);
    assert_true(inside.normal.x == -1.0);
}

TEST_CASE(rays_hit_the_surface)
{
    rlf_ray_hit wall = cast(rlf_vec3_make(0.1, -0.3, 0.2), rlf_vec3_make(0, 0, 1), 6);
    assert_int_equal(wall.reason, RLF_QUERY_HIT);
    assert_int_equal(wall.other, RLF_CONTACT_BACKGROUND);
    assert_int_equal(wall.region_label, 1);
    assert_true(fabs(wall.distance - 3.8) < 1e-3 && wall.normal.z < -0.999);
    rlf_ray_hit floor = cast(rlf_vec3_make(0.3, -0.5, 3), rlf_vec3_make(0, 1, 0), 3);
    assert_true(floor.reason == RLF_QUERY_HIT && fabs(floor.distance - 1.5) < 1e-3);
    assert_true(floor.normal.y < -0.999);
    rlf_ray_hit slab = cast(rlf_vec3_make(0.45, 0.02, 0.1), rlf_vec3_make(0, 0, 1), 6);
    assert_true(slab.reason == RLF_QUERY_HIT && slab.other == RLF_CONTACT_FOREGROUND);
    assert_true(fabs(slab.distance - 1.9) < 1e-3 && slab.region_label == 2);
    rlf_ray_hit back = cast(rlf_vec3_make(0.5, 0.02, 3.5), rlf_vec3_make(0, 0, -1), 6);
    assert_true(back.reason == RLF_QUERY_HIT && back.other == RLF_CONTACT_FOREGROUND);
    assert_true(fabs(back.distance - 1.3) < 0.01 && back.normal.z > 0.99);
}

TEST_CASE(misses_say_why)
{
    rlf_vec3 from = {0.1, 0.2, 0.5};
    assert_int_equal(cast(from, rlf_vec3_make(0, 0, 1), 2).reason, RLF_QUERY_MISS);
    assert_int_equal(cast(from, rlf_vec3_make(-1, 0, 0), 2).reason, RLF_QUERY_OUTSIDE_VIEW);
    assert_int_equal(cast(from, rlf_vec3_make(0, 0, -1), 2).reason, RLF_QUERY_OUTSIDE_VIEW);
    rlf_vec3 corner = {-0.63, -0.52, 1};
    assert_int_equal(cast(rlf_scale(corner, 0.5), corner, 2).reason, RLF_QUERY_MISSING_DEPTH);
    rlf_vec3 hidden = {0.6, 0.0, 2.6}; /* behind the slab */
    assert_int_equal(cast(hidden, rlf_vec3_make(0, 0, 1), 0.1).reason, RLF_QUERY_BEHIND_SURFACE);
    rlf_ray_hit alone = rlf_world_cast_ray(world, NULL, from, rlf_vec3_make(0, 0, 1), 9);
    assert_int_equal(alone.reason, RLF_QUERY_MISS);
    const rlf_vec3 zero = {0, 0, 0}, bad = {NAN, 0, 0};
    assert_int_equal(cast(from, zero, 1).reason, RLF_QUERY_INVALID);
    assert_int_equal(cast(bad, from, 1).reason, RLF_QUERY_INVALID);
    assert_int_equal(cast(from, from, -1).reason, RLF_QUERY_INVALID);
    assert_int_equal(cast(from, from, INFINITY).reason, RLF_QUERY_INVALID);
}

static rlf_overlap near(rlf_vec3 centre, double radius, rlf_body_id *out, int32_t capacity)
{
    return rlf_world_overlap_sphere(world, &fixture->grid, centre, radius, out, capacity);
}

TEST_CASE(spheres_overlap)
{
    rlf_body_id found[2];
    rlf_overlap o = near(rlf_vec3_make(-0.15, 0, 1.5), 0.11, found, 2);
    assert_true(o.reason == RLF_QUERY_HIT && o.body_count == 2);
    assert_true(found[0].index1 == ids[0].index1 && found[1].index1 == ids[1].index1);
    o = near(rlf_vec3_make(-0.3, 0, 1.5), 0.5, found, 2);
    assert_true(o.body_count == 3); /* more than the list holds */
    o = near(rlf_vec3_make(-0.15, 0, 1.5), 0.09, NULL, 0);
    assert_true(o.reason == RLF_QUERY_MISS && o.body_count == 0);
    o = near(rlf_vec3_make(0, -0.2, 3.95), 0.06, NULL, 0);
    assert_true(o.reason == RLF_QUERY_HIT && o.touches_background && !o.touches_foreground);
    o = near(rlf_vec3_make(0.5, 0, 2.1), 0.01, NULL, 0);
    assert_true(o.reason == RLF_QUERY_HIT && o.touches_foreground && !o.touches_background);
    o = near(rlf_vec3_make(0.75, 0, 2.1), 0.06, NULL, 0); /* its side wall */
    assert_true(o.touches_foreground);
    o = near(rlf_vec3_make(0.6, 0, 2.6), 0.05, NULL, 0);
    assert_int_equal(o.reason, RLF_QUERY_BEHIND_SURFACE);
    o = near(rlf_vec3_make(-5, 0, 2), 0.05, NULL, 0);
    assert_int_equal(o.reason, RLF_QUERY_OUTSIDE_VIEW);
    assert_int_equal(near(rlf_vec3_make(0, 0, 1), 0, NULL, 0).reason, RLF_QUERY_INVALID);
}

/* A grid without a plane or function that is read is told, and nothing is asked of it. */
TEST_CASE(an_incomplete_grid_is_refused)
{
    rlf_grid wrong[4];
    for (int k = 0; k < 4; k++) {
        wrong[k] = fixture->grid;
    }
    wrong[0].ray_x = NULL;
    wrong[1].project = NULL;
    wrong[2].foreground.velocity_y = NULL;
    wrong[3].background.normal_z = NULL;
    int told = 0;
    uint64_t hash = rlf_world_hash(world);
    const rlf_vec3 at = {0, 0, 1}, ahead = {0, 0, 1};
    rlf_set_assert(count_assert, &told);
    for (int k = 0; k < 4; k++) {
        assert_int_equal(rlf_world_cast_ray(world, &wrong[k], at, ahead, 9.0).reason,
                         RLF_QUERY_INVALID);
        assert_int_equal(rlf_world_overlap_sphere(world, &wrong[k], at, 0.1, NULL, 0).reason,
                         RLF_QUERY_INVALID);
        rlf_world_advance(world, &wrong[k], 1.0 / 60);
        assert_int_equal(told, 3 * (k + 1));
    }
    rlf_set_assert(NULL, NULL);
    assert_true(rlf_world_hash(world) == hash);
}

TEST_GROUP(set_up, tear_down)
