/* Things that are a few pixels wide, hit from the side, and backs that other pixels show than those
 * under the ball: both turn what is thrown at them, as exact geometry says. */
#include "physics/grid/contact/contact.h"
#include "physics/world_state.h"
#include "small_world.h"
#include "test.h"
#include "grid_shared.h"
#include "heavy.h"

#include <math.h>

#define RESTITUTION 0.8

/* What became of a throw. */
typedef struct flight {
    rlf_vec3 velocity;
    double energy; /* J, of all motion */
    bool has_touched;
} flight;

static void set_pole(double half, double thickness)
{
    grid_plane wall = grid_wall(4);
    grid_fixture_set_room(fixture, &wall, 1);
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0, 0, 2),
                          rlf_vec3_make(half, 0.4, 0), thickness, rlf_vec3_make(0, 0, 0));
}

static rlf_body_def body_of(rlf_shape_type type, double size)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.type = type;
    def.shape.size = rlf_vec3_make(size, size, size);
    def.shape.radius = 0.5 * size;
    def.shape.height = size;
    def.restitution = RESTITUTION;
    def.friction = 0.0;
    return def;
}

static flight throw_it(const rlf_body_def *def, double seconds)
{
    rlf_world_def world_def = small_world_def();
    world_def.gravity = rlf_vec3_make(0, 0, 0);
    world_def.body_capacity = 1;
    world_def.contact_capacity = 64;
    rlf_world *world = world_of(&world_def);
    add_body(world, def);
    flight out = {.has_touched = false};
    for (int i = 0; i < (int)(30 * seconds) + 1; i++) {
        fixture->grid.time_ns++;
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
        const rlf_snapshot *s = rlf_world_get_snapshot(world);
        for (int c = 0; c < s->contact_count; c++) {
            bool is_touch = s->contacts[c].other == RLF_CONTACT_FOREGROUND;
            out.has_touched = out.has_touched || (is_touch && s->contacts[c].impulse > 0.0);
        }
    }
    out.velocity = rlf_world_get_snapshot(world)->bodies[0].velocity;
    out.energy = rlf_world_energy(world);
    rlf_world_destroy(&world);
    return out;
}

/* A pixel is 5.5 mm wide there. A ball is hit in its middle; a box meets the side with a face that
 * a hair's breadth turns, so that only its way is known. */
static bool is_turned(const flight *f, const rlf_body_def *def)
{
    double speed = -def->velocity.x, off = def->shape.type == RLF_SHAPE_BOX ? 0.7 : 0.02;
    return f->has_touched && fabs(f->velocity.x - RESTITUTION * speed) < off * speed &&
           fabs(f->velocity.y) < 0.1 * speed && fabs(f->velocity.z) < 0.1 * speed;
}

TEST_CASE(thin_things_turn_what_hits_their_side)
{
    for (int i = 0; i < heavy(200, 50); i++) {
        double half = 0.003 + 0.0005 * (i % 20), size = 0.02 + 0.02 * (i / 20 % 8);
        set_pole(half, 0.2);
        rlf_body_def def = body_of(i % 2 ? RLF_SHAPE_BOX : RLF_SHAPE_SPHERE, size);
        double speed = 1.0 + 0.37 * (i % 17);
        def.position = rlf_vec3_make(0.4 + 0.003 * (i % 7), 0.003 * (i % 31) - 0.05, 2.1);
        def.velocity = rlf_vec3_make(-speed, 0, 0);
        flight f = throw_it(&def, 0.6 / speed);
        if (!is_turned(&f, &def)) {
            fail_msg("half width %.1f mm, %s of %.2f m at %.2f m/s: %s, then %.2f %.2f %.2f",
                     1e3 * half, i % 2 ? "box" : "ball", size, speed,
                     f.has_touched ? "touched" : "nothing touched", f.velocity.x, f.velocity.y,
                     f.velocity.z);
        }
    }
}

/* A spinning capsule pokes through a thin slab for a moment: it is not torn both ways. */
TEST_CASE(thin_things_give_no_energy)
{
    set_pole(0.012, 0.2);
    for (int i = 0; i < heavy(200, 50); i++) {
        rlf_body_def def = body_of((rlf_shape_type)(i % 4), 0.1 + 0.003 * (i % 21));
        def.friction = 0.1 * (i % 11);
        def.position = rlf_vec3_make(0.45, 0.004 * (i % 41) - 0.08, 2.04 + 0.005 * (i % 23));
        def.velocity = rlf_vec3_make(-0.5 - 0.11 * (i % 37), 0, 0);
        def.angular_velocity = rlf_vec3_make(i % 5 * 4.0 - 8, i % 7 * 3.0 - 9, i % 3 * 8.0 - 8);
        def.orientation = rlf_quat_from_rotation_vector(rlf_vec3_make(0.1 * i, 0.2 * i, 0.3 * i));
        flight before = throw_it(&def, 0), f = throw_it(&def, 1.0);
        if (f.energy > 1.01 * before.energy) {
            print_message("throw %d: %.3f J became %.3f J\n", i, before.energy, f.energy);
        }
        assert_true(f.energy < 1.01 * before.energy);
    }
}

/* Small balls at the back of a board, at angles of up to 13 deg to the view: the pixels on whose
 * rays the back is hit are others than those under the ball. */
TEST_CASE(backs_turn_small_balls)
{
    grid_plane wall = grid_wall(4);
    grid_fixture_set_room(fixture, &wall, 1);
    grid_fixture_set_slab(fixture, grid_wall(2), rlf_vec3_make(0, 0, 2), rlf_vec3_make(0.5, 0.5, 0),
                          0.2, rlf_vec3_make(0, 0, 0));
    for (int i = 0; i < heavy(300, 75); i++) {
        rlf_body_def def = body_of(RLF_SHAPE_SPHERE, 0.02 + 0.001 * (i % 20));
        double speed = 0.5 + 0.13 * (i % 40);
        def.position = rlf_vec3_make(0.03 * (i % 29) - 0.42, 0.028 * (i % 31) - 0.42, 2.6);
        def.velocity = rlf_vec3_make(0, 0, -speed);
        flight f = throw_it(&def, 0.6 / speed);
        assert_true(f.has_touched);
        assert_true(fabs(f.velocity.z - RESTITUTION * speed) < 0.02 * speed);
    }
}

/* What no contact stops, the guard does: as a blow at the centre, with restitution and friction,
 * that is told as any other contact is. */
TEST_CASE(the_last_defence_is_a_contact)
{
    set_pole(0.2, 0.2);
    rlf_world_def world_def = small_world_def();
    rlf_world *world = world_of(&world_def);
    rlf_body_def def = body_of(RLF_SHAPE_BOX, 0.1);
    def.friction = 0.25;
    def.mass = 2.0;
    def.position = rlf_vec3_make(0.01, 0.02, 1.99);
    def.velocity = rlf_vec3_make(3, 0, 4);
    add_body(world, &def);
    phys_body *body = &world->bodies[0];
    grid_query query = {.grid = &fixture->grid, .T_grid_world = rlf_pose_identity(), .step = 0.01};
    body->x = rlf_mad(def.position, def.velocity, query.step);
    grid_guard_centre(&query, body, 0, def.position);
    rlf_vec3 expected = {3.0 - 0.25 * 1.8 * 4.0, 0, -3.2};
    assert_true(rlf_length(rlf_sub(body->v, expected)) < 1e-6);
    assert_true(rlf_length(rlf_sub(body->x, def.position)) < 1e-9);
    assert_int_equal(body->surface_count, 1);
    const phys_contact *c = &body->surface[0];
    assert_int_equal(c->other, RLF_CONTACT_FOREGROUND);
    assert_int_equal(c->label, 2);
    assert_true(fabs(c->impulse_sum - 2.0 * 7.2) < 1e-6 && fabs(c->approach - 4.0) < 1e-6);
    assert_true(c->normal.z < -0.999);
    body->x = rlf_mad(def.position, def.velocity, query.step); /* it flies away from the face */
    grid_guard_centre(&query, body, 0, def.position);
    assert_true(body->x.z > 2.0 && body->surface_count == 1);
    rlf_world_destroy(&world);
}

TEST_EACH(set_up, tear_down)
