/* Random throws into a concave room: nothing tunnels, nothing is NaN. */
#include "draws.h"
#include "small_world.h"
#include "test.h"
#include "grid_shared.h"
#include "heavy.h"

#include <math.h>

#define THROWS heavy(200, 40)

/* Floor, back wall, two side walls and a ramp, all within the view. */
static const grid_plane ROOM[5] = {{{0, -1, 0}, -1.0},
                                   {{0, 0, -1}, -4.5},
                                   {{1, 0, 0}, -1.6},
                                   {{-1, 0, 0}, -1.6},
                                   {{0, -0.6, -0.8}, -3.6}};

/* How far p is out of the room, metres; <= 0 inside. */
static double outside(rlf_vec3 p)
{
    double worst = -1e9;
    for (int i = 0; i < 5; i++) {
        worst = rlf_max(worst, ROOM[i].d - rlf_dot(ROOM[i].n, p));
    }
    return worst;
}

static bool is_in_view(rlf_vec3 p)
{
    double u, v;
    return grid_fixture_project(NULL, p, &u, &v) && u > 5 && v > 5 && u < GRID_W - 6 &&
           v < GRID_H - 6;
}

static rlf_body_def random_throw(uint64_t *r)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = (rlf_shape_type)(int)(draw(r, 0, 1) * 4);
    double size = 0.02 + 0.13 * draw(r, 0, 1);
    def.shape.size = draw_in_box(r, rlf_vec3_make(size, 0.5 * size, 0.5 * size),
                                 rlf_vec3_make(size, 1.5 * size, 1.5 * size));
    def.shape.radius = 0.5 * size;
    def.shape.height = size * (0.5 + draw(r, 0, 1));
    def.mass = 0.05 + draw(r, 0, 1);
    def.restitution = draw(r, 0, 1);
    def.friction = draw(r, 0, 1);
    def.position = draw_in_box(r, rlf_vec3_make(-0.6, -0.5, 1.3), rlf_vec3_make(0.6, 0.3, 2.3));
    rlf_vec3 turn = draw_in_box(r, rlf_vec3_make(-3, -3, -3), rlf_vec3_make(3, 3, 3));
    def.orientation = rlf_quat_from_rotation_vector(turn);
    rlf_vec3 target = draw_in_box(r, rlf_vec3_make(-1.2, -0.6, 3.5), rlf_vec3_make(1.2, 1, 4.5));
    double speed = 0.5 + 9.5 * draw(r, 0, 1);
    def.velocity = rlf_scale(rlf_normalize(rlf_sub(target, def.position)), speed);
    def.angular_velocity = draw_in_box(r, rlf_vec3_make(-10, -10, -10), rlf_vec3_make(10, 10, 10));
    return def;
}

TEST_CASE(nothing_tunnels)
{
    grid_fixture_set_room(fixture, ROOM, 5);
    uint64_t r = 7;
    int tunnelled = 0, bounced = 0, left = 0;
    double worst = 0;
    for (int i = 0; i < THROWS; i++) {
        rlf_world_def world_def = small_world_def();
        world_def.body_capacity = 1;
        world_def.contact_capacity = 64;
        rlf_world *world = world_of(&world_def);
        rlf_body_def def = random_throw(&r);
        add_body(world, &def);
        bool is_lost = false, has_touched = false;
        for (int k = 0; k < 60 && !is_lost; k++) {
            fixture->grid.time_ns++;
            rlf_world_advance(world, &fixture->grid, 1.0 / 30);
            const rlf_snapshot *s = rlf_world_get_snapshot(world);
            if (s->body_count == 0) {
                break;
            }
            const rlf_body_state *b = &s->bodies[0];
            assert_true(rlf_vec3_is_finite(b->T_world_body.p));
            assert_true(rlf_vec3_is_finite(b->velocity));
            assert_true(rlf_vec3_is_finite(b->angular_velocity));
            has_touched = has_touched || s->contact_count > 0;
            if (!is_in_view(b->T_world_body.p)) { /* where nothing is seen, nothing is solid */
                left++;
                break;
            }
            worst = rlf_max(worst, outside(b->T_world_body.p));
            is_lost = outside(b->T_world_body.p) > 0;
        }
        tunnelled += is_lost;
        bounced += has_touched;
        if (is_lost) {
            print_message("throw %d: shape %d through\n", i, (int)def.shape.type);
        }
        rlf_world_destroy(&world);
    }
    print_message("THROW: %d of %d tunnelled, %d touched, %d left the view; centre at most %.1f mm "
                  "outside\n",
                  tunnelled, THROWS, bounced, left, 1e3 * worst);
    assert_int_equal(tunnelled, 0);
    assert_true(bounced > THROWS * 9 / 10);
    assert_true(left < THROWS / 2);
}

/* Throws at the unseen back of a slab, or at the side of a book seen edge-on. */
static void throws_at(bool is_edge)
{
    grid_fixture_set_room(fixture, ROOM, 5);
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0, 0, 2),
                          is_edge ? rlf_vec3_make(0.012, 0.2, 0) : rlf_vec3_make(0.25, 0.5, 0), 0.2,
                          rlf_vec3_make(0, 0, 0));
    uint64_t r = 9;
    const int count = heavy(100, 25);
    int bounced = 0, passed = 0;
    for (int i = 0; i < count; i++) {
        rlf_world_def world_def = small_world_def();
        world_def.body_capacity = 1;
        world_def.contact_capacity = 64;
        world_def.gravity = rlf_vec3_make(0, 0, 0);
        rlf_world *world = world_of(&world_def);
        rlf_body_def def = random_throw(&r);
        double speed = 0.5 + 4.5 * draw(&r, 0, 1);
        if (is_edge) {
            double y = 0.2 * draw(&r, 0, 1) - 0.1;
            def.position = rlf_vec3_make(0.5, y, 2.05 + 0.1 * draw(&r, 0, 1));
            def.velocity = rlf_vec3_make(-speed, 0, 0);
        } else {
            double x = 0.3 * draw(&r, 0, 1) - 0.15;
            def.position = rlf_vec3_make(x, 0.6 * draw(&r, 0, 1) - 0.3, 3);
            def.velocity = rlf_vec3_make(0, 0, -speed);
        }
        add_body(world, &def);
        bool has_touched = false, is_through = false;
        for (int k = 0; k < (int)(36 / speed) + 2; k++) {
            fixture->grid.time_ns++;
            rlf_world_advance(world, &fixture->grid, 1.0 / 30);
            const rlf_snapshot *s = rlf_world_get_snapshot(world);
            rlf_vec3 p = s->bodies[0].T_world_body.p;
            for (int c = 0; c < s->contact_count; c++) {
                has_touched = has_touched || s->contacts[c].other == RLF_CONTACT_FOREGROUND;
            }
            is_through = is_through || (is_edge ? p.x < 0 : p.z < 2);
        }
        bounced += has_touched && !is_through;
        passed += is_through;
        rlf_world_destroy(&world);
    }
    print_message("%s: %d of %d bounced, %d passed\n", is_edge ? "EDGE" : "BEHIND", bounced, count,
                  passed);
    assert_int_equal(passed, 0);
    assert_true(bounced >= count - 1);
}

TEST_CASE(backs_and_edges_are_solid)
{
    throws_at(false);
    throws_at(true);
}

/* A body that gets out of the room in view is lost; one that goes where the camera sees nothing has
 * left, and nothing holds it there. Both are counted once. */
static void count_losses(const rlf_snapshot *s, bool *was_in_view, int *left, int *lost)
{
    for (int i = 0; i < s->body_count; i++) {
        rlf_vec3 p = s->bodies[i].T_world_body.p;
        bool *was = &was_in_view[s->bodies[i].id.index1 - 1];
        bool is_out = outside(p) > 0.0;
        *lost += *was && is_out && is_in_view(p);
        *left += *was && !is_in_view(p);
        *was = is_in_view(p) && !is_out;
    }
}

TEST_CASE(a_crowd_stays_in_the_room)
{
    enum { CUBES = 100, FRAMES = 120 };
    grid_fixture_set_room(fixture, ROOM, 5);
    rlf_world_def world_def = rlf_world_def_default();
    rlf_world *world = world_of(&world_def);
    uint64_t r = 3;
    for (int i = 0; i < CUBES; i++) {
        rlf_body_def def = rlf_body_def_default();
        def.position = draw_in_box(&r, rlf_vec3_make(-0.8, 0.8, 2.2), rlf_vec3_make(0.8, 0.8, 3.0));
        def.position.y -= 0.15 * (i / 20);
        rlf_vec3 turn = draw_in_box(&r, rlf_vec3_make(0, 0, 0), rlf_vec3_make(2, 2, 2));
        def.orientation = rlf_quat_from_rotation_vector(turn);
        add_body(world, &def);
    }
    bool was_in_view[CUBES] = {false};
    int left = 0, lost = 0;
    for (int k = 0; k < FRAMES; k++) {
        advance_frames(world, &fixture->grid, 1, 1.0 / 30);
        count_losses(rlf_world_get_snapshot(world), was_in_view, &left, &lost);
    }
    print_message("%d cubes: %d left the view, %d lost\n", CUBES, left, lost);
    assert_int_equal(lost, 0);
    rlf_world_destroy(&world);
}

TEST_EACH(set_up, tear_down)
