/* A body that something came over does not leave it through a back behind which there is no room,
 * as the sole of a foot: the floor holds against that, and it would stay for ever. */
#include "small_world.h"
#include "test.h"
#include "grid_shared.h"

#define FRONT 1.9
#define THICK 0.12
#define HALF 0.03

/* A slab before a wall that is so far behind its back. */
static void set_slab(double room)
{
    grid_plane wall = grid_wall(FRONT + THICK + room);
    grid_fixture_set_room(fixture, &wall, 1);
    grid_fixture_set_slab(fixture, grid_wall(FRONT), rlf_vec3_make(0, 0, FRONT),
                          rlf_vec3_make(0.3, 0.3, 0), THICK, rlf_vec3_make(0, 0, 0));
}

/* Where a small cube comes to in a second that was in the slab at this depth, nearer to its back
 * than to its front. */
static rlf_vec3 way_out(rlf_vec3 from)
{
    rlf_body_def def = rlf_body_def_default();
    def.shape.size = rlf_vec3_make(2 * HALF, 2 * HALF, 2 * HALF);
    def.position = from;
    return alone_after(&def, &fixture->grid, 30).T_world_body.p;
}

TEST_CASE(back_with_room_behind_it_is_a_way_out)
{
    set_slab(1.0);
    for (double y = -0.1; y < 0.11; y += 0.05) {
        assert_true(way_out(rlf_vec3_make(0.05, y, FRONT + THICK - 0.02)).z > FRONT + THICK);
    }
}

TEST_CASE(back_that_lies_on_the_wall_is_none)
{
    set_slab(0.005);
    for (double y = -0.1; y < 0.11; y += 0.05) {
        rlf_vec3 to = way_out(rlf_vec3_make(0.05, y, FRONT + THICK - HALF));
        assert_less(to.z, FRONT);
    }
}

TEST_GROUP(set_up, tear_down)
