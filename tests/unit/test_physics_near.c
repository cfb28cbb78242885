/* The broad phase against every body held against every other. */
#include "analytic.h"
#include "physics/pair/collide.h"
#include "small_world.h"
#include "test.h"

#include <math.h>

enum { BODIES = 300 };
#define HORIZON 0.02

static double between(analytic_random *r, double low, double high)
{
    return low + (high - low) * random_uniform(r);
}

/* Cubes of many sizes in a room, some of them fast; every fourth sleeps, every ninth is held. */
static rlf_world *make_crowd(analytic_random *r, double spread)
{
    rlf_world *world = NULL;
    rlf_world_def def = small_world_def();
    def.body_capacity = BODIES;
    def.contact_capacity = BODIES * BODIES * 2;
    world = world_of(&def);
    for (int32_t i = 0; i < BODIES; i++) {
        rlf_body_def body = rlf_body_def_default();
        double size = i % 50 == 0 ? 1.5 : between(r, 0.02, 0.2);
        body.shape.size = rlf_vec3_make(size, size, size);
        body.position =
            rlf_vec3_make(between(r, -spread, spread), between(r, -0.5, 0.5), between(r, 1.0, 2.0));
        body.velocity = rlf_vec3_make(0, between(r, -5, 5), 0);
        add_body(world, &body);
        world->bodies[i].is_asleep = i % 4 == 1;
        world->bodies[i].inverse_mass *= i % 9 == 2 ? 0.0 : 1.0;
    }
    return world;
}

static bool are_near(const rlf_world *world, int32_t i, int32_t k)
{
    const phys_proxy *a = &world->proxies[i], *b = &world->proxies[k];
    rlf_vec3 d = rlf_sub(a->centre, b->centre), half = rlf_add(a->half, b->half);
    bool is_apart = fabs(d.x) > half.x || fabs(d.y) > half.y || fabs(d.z) > half.z;
    return !is_apart && !(a->is_idle && b->is_idle) && !(a->is_fixed && b->is_fixed);
}

static void check(const rlf_world *world, bool (*is_there)(int32_t))
{
    int32_t at = 0;
    for (int32_t i = 0; i < BODIES; i++) {
        for (int32_t k = i + 1; k < BODIES; k++) {
            if (is_there(i) && is_there(k) && are_near(world, i, k)) {
                assert_true(at < world->near_count);
                assert_int_equal(world->near_sorted[at].a, i);
                assert_int_equal(world->near_sorted[at++].b, k);
            }
        }
    }
    assert_int_equal(at, world->near_count);
    assert_true(at > 100);
}

static bool always(int32_t i)
{
    return i >= 0;
}

static bool is_number(int32_t i)
{
    return i != 7;
}

TEST_CASE(near_ones_are_those_whose_boxes_overlap)
{
    analytic_random r = {2};
    const double SPREADS[3] = {0.1, 1.0, 3.0};
    for (int32_t run = 0; run < 3; run++) {
        rlf_world *world = make_crowd(&r, SPREADS[run]);
        phys_find_near(world, HORIZON);
        check(world, always);
        rlf_world_destroy(&world);
    }
}

/* One that is far away, and a place that is no number, change nothing for the others. */
TEST_CASE(odd_places_do_no_harm)
{
    analytic_random r = {4};
    rlf_world *world = make_crowd(&r, 1.0);
    world->bodies[3].x = rlf_vec3_make(1e12, 0, 0);
    world->bodies[7].x.y = NAN;
    phys_find_near(world, HORIZON);
    check(world, is_number);
    rlf_world_destroy(&world);
}
