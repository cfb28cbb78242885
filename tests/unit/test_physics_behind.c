/* What comes at somebody from behind goes back there, though a frame has a hole in him or takes him
 * for the room: it neither stays in him nor comes out in front. */
#include "small_world.h"
#include "test.h"
#include "grid_shared.h"

#define FRONT 1.9
#define THICK 0.12
#define RADIUS 0.04
#define SPEED 3.0

typedef enum loss { HOLE, ROOM } loss;

/* Somebody in one frame, or what is left of him. */
static void show(bool is_lost, loss kind)
{
    const rlf_vec3 at_rest = {0, 0, 0};
    grid_fixture_set_slab(fixture, grid_wall(FRONT), rlf_vec3_make(0, 0, FRONT),
                          rlf_vec3_make(0.3, 0.3, 0), THICK, at_rest);
    for (int32_t i = 0; i < GRID_W * GRID_H && is_lost; i++) {
        fixture->planes[6][i] = kind == HOLE ? 0.0f : fixture->planes[6][i];
        fixture->mask[i] = 0;
    }
    fixture->grid.time_ns += 33333333;
}

/* Where a ball comes to in 0.4 s that starts so far behind his back, when the second frame is lost;
 * metres behind his front. */
static double way_out(double from, loss kind)
{
    rlf_world_def world_def = small_world_def();
    world_def.gravity = rlf_vec3_make(0, 0, 0);
    rlf_world *world = world_of(&world_def);
    rlf_body_def def = rlf_body_def_default();
    def.shape = (rlf_shape){.type = RLF_SHAPE_SPHERE, .radius = RADIUS};
    def.position = rlf_vec3_make(0.05, 0.02, FRONT + THICK + RADIUS + from);
    def.velocity = rlf_vec3_make(0, 0, -SPEED);
    add_body(world, &def);
    for (int32_t k = 0; k < 12; k++) {
        show(k == 1, kind);
        rlf_world_advance(world, &fixture->grid, 1.0 / 30);
    }
    const double z = rlf_world_get_snapshot(world)->bodies[0].T_world_body.p.z;
    rlf_world_destroy(&world);
    return z - FRONT;
}

static void check(loss kind)
{
    const grid_plane wall = grid_wall(FRONT + 1.5);
    grid_fixture_set_room(fixture, &wall, 1);
    for (int32_t k = 0; k < 8; k++) {
        const double from = 0.1 + 0.0125 * k, at = way_out(from, kind);
        if (!(at > THICK)) {
            fail_msg("from %.3f m: %.3f m behind his front", from, at);
        }
    }
}

TEST_CASE(a_hole_of_a_frame_lets_nothing_in)
{
    check(HOLE);
}

TEST_CASE(who_is_lost_for_a_frame_lets_nothing_in)
{
    check(ROOM);
}

TEST_GROUP(set_up, tear_down)
